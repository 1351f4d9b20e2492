#include "app/lab/map/map_resume.h"

#include "app/lab/csv.h"
#include "app/lab/fingerprint.h"
#include "app/lab/map/answers.h"

namespace plumb {

std::string map_fingerprint(const SceneText &scene, const MapAxis &x, const MapAxis &y,
                            const MapOptions &options) {
    Fingerprint print;
    print.add(scene.text);
    for (const ChangedNumber &number : scene.changed) {
        print.add(number.path);
        print.add(number.value);
    }
    for (const MapAxis *axis : {&x, &y}) {
        print.add(axis->name);
        print.add(axis->logarithmic ? 1 : 0);
        if (varies_the_scene(*axis)) { // its ends decide which expectations hold
            print.add(axis->values.front());
            print.add(axis->values.back());
        }
    }
    print.add(options.base);
    print.add(options.duration.value_or(0));
    return print.text();
}

std::vector<std::string> map_key_columns(const StabilityMap &map) {
    return {"kind", "method", map.x.name, map.y.name, "low", "high", "run"};
}

KnownRows read_map_csv(std::istream &in, const std::string &fingerprint) {
    constexpr std::size_t read = 13; // then settings and where it was made; the fingerprint is last
    KnownRows known;
    for (std::vector<std::string> row = read_csv_row(in); !row.empty(); row = read_csv_row(in)) {
        if (row.size() <= read || row.back() != fingerprint)
            continue;
        const std::optional<Failing> failing = find_failing(row[6]);
        const auto x = csv_number(row[2]), y = csv_number(row[3]), low = csv_number(row[4]),
                   high = csv_number(row[5]);
        if (!failing || !x || !y || !low || !high)
            continue;
        const RunFailing why{*failing, row[7]};
        if (row[0] == "limit") {
            known.limits[{row[1], *y}].push_back({*y, *low, *high, row[8] == "1", why});
            continue;
        }
        const auto time = csv_number(row[9]), penetration = csv_number(row[10]),
                   drift = csv_number(row[11]), gain = csv_number(row[12]);
        if (time && penetration && drift && gain)
            known.cells[{row[1], *x, *y}] = {why, *time, *penetration, *drift, *gain};
    }
    return known;
}

} // namespace plumb
