#include "app/lab/map/stability_map.h"

#include "app/lab/chart/chart_columns.h"
#include "app/lab/csv.h"
#include "app/lab/provenance.h"
#include "app/lab/run/method_choice.h"
#include "app/lab/run/run_text.h"

#include <algorithm>
#include <cstdio>
#include <set>

namespace plumb {

namespace {

// The failing, and its subject if it has one, such as the missed expectation.
std::string in_words(const RunFailing &failing) {
    return std::string(info_of(failing.failing).name) +
           (failing.what.empty() ? "" : ": " + failing.what);
}

std::string joined(const std::vector<std::string> &names) {
    std::string all;
    for (const std::string &name : names)
        all += (all.empty() ? "" : "; ") + name;
    return all;
}

void print_grid(std::ostream &out, const StabilityMap &map, const MethodMap &of_method) {
    std::vector<std::string> labels;
    std::size_t width = 0;
    for (const double y : map.y.values) {
        labels.push_back(value_label(map.y, y));
        width = std::max(width, labels.back().size());
    }
    for (std::size_t row = map.y.values.size(); row-- > 0;) {
        out << "  " << std::string(width - labels[row].size(), ' ') << labels[row] << "  ";
        for (std::size_t column = 0; column < map.x.values.size(); ++column) {
            const auto &run = map.cell(of_method, column, row);
            out << (run ? info_of(run->failing.failing).letter : ' ');
        }
        out << '\n';
    }
}

} // namespace

void write_map_csv(std::ostream &out, const StabilityMap &map) {
    CsvWriter csv(out);
    csv.cell("kind").cell("method").cell(map.x.name).cell(map.y.name);
    for (const char *column : {"low", "high", "why", "what", "held_below", "time",
                               "max_penetration", "max_joint_drift", "max_energy_gain"})
        csv.cell(column);
    std::vector<SettingNumber> settings; // the axes have their own columns
    for (const SettingNumber number : setting_numbers())
        if (map.x.setting != number && map.y.setting != number)
            settings.push_back(number);
    for (const SettingNumber number : settings)
        csv.cell(setting_column(number));
    csv.cell("not_judged").cell("precision").cell("machine").cell("commit").cell("run");
    csv.end_row();
    const std::string here = machine(), commit = build_commit();
    const auto end_row = [&](const MethodMap &of_method) {
        for (const SettingNumber number : settings)
            csv.cell(setting_value(of_method.settings, number));
        csv.cell(joined(map.outdated)).cell(precision_name(map.precision)).cell(here).cell(commit);
        csv.cell(map.fingerprint).end_row();
    };
    for (const MethodMap &of_method : map.methods) {
        for (std::size_t row = 0; row < map.y.values.size(); ++row)
            for (std::size_t column = 0; column < map.x.values.size(); ++column) {
                const auto &run = map.cell(of_method, column, row);
                if (!run)
                    continue;
                const double x = map.x.values[column];
                csv.cell("cell").cell(of_method.method->name).cell(x).cell(map.y.values[row]);
                csv.cell(x).cell(x).cell(info_of(run->failing.failing).name);
                csv.cell(run->failing.what).cell("").cell(run->time).cell(run->max_penetration);
                csv.cell(run->max_joint_drift).cell(run->max_energy_gain);
                end_row(of_method);
            }
        for (const MapLimit &limit : of_method.limits) {
            csv.cell("limit").cell(of_method.method->name);
            csv.cell(between(map.x, limit.low, limit.high)).cell(limit.y);
            csv.cell(limit.low).cell(limit.high).cell(info_of(limit.failing.failing).name);
            csv.cell(limit.failing.what).cell(limit.held_below);
            csv.cell("").cell("").cell("").cell("");
            end_row(of_method);
        }
    }
}

void print(std::ostream &out, const StabilityMap &map) {
    out << map.scene.name << ": x: " << axis_title(map.x) << ", from "
        << value_label(map.x, map.x.values[0]) << " to " << value_label(map.x, map.x.values.back())
        << "; y: " << axis_title(map.y) << '\n';
    std::set<Failing> seen;
    std::set<std::string> missed;
    for (const MethodMap &of_method : map.methods) {
        out << of_method.method->name << '\n';
        print_grid(out, map, of_method);
        for (const auto &run : of_method.cells)
            if (run) {
                seen.insert(run->failing.failing);
                if (!run->failing.what.empty())
                    missed.insert(in_words(run->failing));
            }
    }
    for (const FailingInfo &info : failings())
        if (seen.contains(info.failing))
            out << "  " << info.letter << "  " << info.meaning << '\n';
    for (const std::string &what : missed)
        out << "  " << what << '\n';
    for (const std::string &what : map.unjudged)
        out << "  " << what << '\n';
    for (const std::string &why : grouped_reasons(map.left_out))
        out << "  left out: " << why << '\n';
    if (map.interrupted)
        out << "  interrupted: blank cells were not run\n";
}

} // namespace plumb
