#include "app/lab/map/map_resume.h"

#include "engine/core/hash.h"

#include <array>
#include <charconv>
#include <fstream>
#include <iterator>

namespace plumb {

namespace {

void add(StateHash &hash, std::string_view text) {
    hash.add(static_cast<std::uint64_t>(text.size()));
    for (const char c : text)
        hash.add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

// The program itself: another build may come to other results.
std::string program_text() {
    std::ifstream program("/proc/self/exe", std::ios::binary);
    return {std::istreambuf_iterator<char>(program), {}};
}

// One row of comma-separated values, quoted ones of several lines included; empty at the end. A row
// that the end cuts off is dropped.
std::vector<std::string> read_row(std::istream &in) {
    std::vector<std::string> row{""};
    bool quoted = false;
    for (int next = in.get(); next != std::istream::traits_type::eof(); next = in.get()) {
        const char c = static_cast<char>(next);
        if (c == '"') {
            if (quoted && in.peek() == '"')
                row.back() += static_cast<char>(in.get());
            else
                quoted = !quoted;
        } else if (c == ',' && !quoted) {
            row.emplace_back();
        } else if (c == '\n' && !quoted) {
            return row;
        } else {
            row.back() += c;
        }
    }
    return {};
}

std::optional<double> number(const std::string &text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value)
                                                                    : std::nullopt;
}

} // namespace

std::string map_fingerprint(const SceneText &scene, const MapAxis &x, const MapAxis &y,
                            const MapOptions &options) {
    StateHash hash;
    add(hash, program_text());
    add(hash, scene.text);
    for (const MapAxis *axis : {&x, &y}) {
        add(hash, axis->name);
        hash.add(static_cast<std::uint64_t>(axis->logarithmic));
    }
    for (const SettingNumber setting : setting_numbers())
        if (const std::optional<double> value = options.base.settings.find(setting)) {
            add(hash, setting_name(setting));
            hash.add(*value);
        }
    hash.add(static_cast<std::uint64_t>(
        options.base.precision ? 1 + static_cast<int>(*options.base.precision) : 0));
    hash.add(options.duration.value_or(0));
    constexpr std::size_t digits = 16;
    std::array<char, digits> text{};
    const auto written = std::to_chars(text.data(), text.data() + text.size(), hash.value(), 16);
    return {text.data(), written.ptr};
}

KnownRows read_map_csv(std::istream &in, const std::string &fingerprint) {
    constexpr std::size_t columns = 14;
    KnownRows known;
    for (std::vector<std::string> row = read_row(in); !row.empty(); row = read_row(in)) {
        if (row.size() != columns || row[13] != fingerprint)
            continue;
        const std::optional<Failing> failing = find_failing(row[6]);
        const auto x = number(row[2]), y = number(row[3]), low = number(row[4]),
                   high = number(row[5]);
        if (!failing || !x || !y || !low || !high)
            continue;
        const RunFailing why{*failing, row[7]};
        if (row[0] == "limit") {
            known.limits[{row[1], *y}].push_back({*y, *low, *high, row[8] == "1", why});
            continue;
        }
        const auto time = number(row[9]), penetration = number(row[10]), drift = number(row[11]),
                   gain = number(row[12]);
        if (time && penetration && drift && gain)
            known.cells[{row[1], *x, *y}] = {why, *time, *penetration, *drift, *gain};
    }
    return known;
}

} // namespace plumb
