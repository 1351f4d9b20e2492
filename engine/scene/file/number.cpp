#include "engine/scene/file/number.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace plumb {

namespace {

template <typename Float> std::string digits(Float value) {
    std::array<char, 64> buffer{};
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    static_cast<void>(error); // 64 characters hold any double
    std::string text(buffer.data(), end);
    // TOML integers have no minus zero and end at 2^63.
    const bool looks_whole = text.find_first_not_of("-0123456789") == std::string::npos;
    if (looks_whole && (value == 0 ? std::signbit(value) : std::abs(value) >= Float(1e15)))
        text += ".0";
    return text;
}

} // namespace

std::string shortest(double value) {
    return digits(value);
}

std::string shortest(float value) {
    const std::string text = digits(value);
    double read = 0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    // Double rounding may give the neighbour; then all digits are needed.
    return static_cast<float>(read) == value ? text : digits(static_cast<double>(value));
}

} // namespace plumb
