#include "app/lab/fingerprint.h"

#include <array>
#include <charconv>
#include <fstream>
#include <iterator>

namespace plumb {

Fingerprint::Fingerprint() {
    std::ifstream program("/proc/self/exe", std::ios::binary);
    add(std::string(std::istreambuf_iterator<char>(program), {}));
}

void Fingerprint::add(std::string_view text) {
    hash_.add(static_cast<std::uint64_t>(text.size()));
    for (const char c : text)
        hash_.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

void Fingerprint::add(const RunOptions &options) {
    for (const SettingNumber setting : setting_numbers())
        if (const std::optional<double> value = options.settings.find(setting)) {
            add(setting_name(setting));
            hash_.add(*value);
        }
    hash_.add(static_cast<std::uint64_t>(
        options.precision ? 1 + static_cast<int>(*options.precision) : 0));
}

std::string Fingerprint::text() const {
    constexpr std::size_t digits = 16;
    std::array<char, digits> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), hash_.value(), 16);
    return {text.data(), written.ptr};
}

} // namespace plumb
