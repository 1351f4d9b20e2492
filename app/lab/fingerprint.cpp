#include "app/lab/fingerprint.h"

#include <array>
#include <charconv>
#include <fstream>
#include <iterator>

namespace plumb {

namespace {

std::string hexadecimal(std::uint64_t value) {
    constexpr std::size_t digits = 16;
    std::array<char, digits> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), value, 16);
    return {text.data(), written.ptr};
}

void add_bytes(StateHash &hash, std::string_view text) {
    hash.add(static_cast<std::uint64_t>(text.size()));
    for (const char c : text)
        hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

} // namespace

void Fingerprint::add(std::string_view text) {
    add_bytes(hash_, text);
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
    return of_program() + "-" + hexadecimal(hash_.value());
}

const std::string &Fingerprint::of_program() {
    static const std::string program = [] {
        std::ifstream file("/proc/self/exe", std::ios::binary);
        StateHash hash;
        add_bytes(hash, std::string(std::istreambuf_iterator<char>(file), {}));
        return hexadecimal(hash.value());
    }();
    return program;
}

} // namespace plumb
