#include "engine/scene/file/text.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace plumb::scene_file {

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const glm::dvec3 &a, const glm::dvec3 &b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

std::string array_of(std::span<const double> values) {
    std::string text = "[";
    for (std::size_t i = 0; i < values.size(); ++i)
        text += (i % 10 == 0 ? "\n    " : " ") + shortest(values[i]) + ',';
    return text + "\n]";
}

std::string rotation(const glm::dquat &q) {
    return "[" + shortest(q.w) + ", " + shortest(q.x) + ", " + shortest(q.y) + ", " +
           shortest(q.z) + "]";
}

// Appends a character that a basic string cannot hold unescaped.
void append_escaped(std::string &text, char c) {
    constexpr std::string_view hex = "0123456789ABCDEF";
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
        text += {'\\', c};
    else if (c == '\n')
        text += "\\n";
    else if (c == '\t')
        text += "\\t";
    else if (c == '\r')
        text += "\\r";
    else if (code < 0x20 || code == 0x7F)
        text += "\\u00", text += hex[code >> 4], text += hex[code & 0xF];
    else
        text += c;
}

std::string string(std::string_view value) {
    std::string text = "\"";
    for (const char c : value)
        append_escaped(text, c);
    return text + '"';
}

std::optional<double> exact_degrees(double radians) {
    constexpr double one = std::numbers::pi / 180;
    const double degrees = radians / one;
    for (const double candidate :
         {std::round(degrees * 1e6) / 1e6, std::round(degrees * 1e12) / 1e12, degrees})
        if (same_bits(candidate * one, radians))
            return candidate;
    return std::nullopt;
}

std::string angle_in_line(const std::string &key, double radians) {
    if (const std::optional<double> degrees = exact_degrees(radians))
        return key + "_deg = " + shortest(*degrees);
    return key + " = " + shortest(radians);
}

std::string angle(const std::string &key, double radians) {
    return angle_in_line(key, radians) + "\n";
}

} // namespace plumb::scene_file
