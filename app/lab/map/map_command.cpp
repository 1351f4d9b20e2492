#include "app/lab/map/stability_map.h"

#include "app/files/output_file.h"
#include "app/lab/chart/chart_image.h"
#include "app/lab/chart/chart_svg.h"
#include "app/lab/interrupt.h"
#include "app/lab/map/map_picture.h"
#include "app/lab/map/map_resume.h"
#include "app/lab/map/theory.h"
#include "app/lab/partial_table.h"
#include "app/lab/provenance.h"
#include "app/lab/run/method_choice.h"
#include "app/lab/run/run_text.h"
#include "app/lab/run/sweep.h"
#include "app/render/context.h"
#include "app/render/png.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

namespace plumb {

namespace {

// A setting's value: "4", or "4 (soft_step), 1 (rk4)" if methods differ.
std::string values_by_method(const StabilityMap &map, SettingNumber number) {
    std::vector<std::pair<std::string, std::string>> values;
    for (const MethodMap &of_method : map.methods)
        values.emplace_back(of_method.method->name,
                            setting_label(number, setting_value(of_method.settings, number)));
    return values_by_name(values);
}

// dt, substeps and any setting with a value that is not its method's default, unless on an axis;
// then precision, machine and commit.
std::string made_with(const StabilityMap &map) {
    std::string text;
    const auto add = [&](const std::string &part) { text += (text.empty() ? "" : "  ·  ") + part; };
    for (const SettingNumber number : setting_numbers()) {
        const bool is_said = std::ranges::any_of(map.methods, [&](const MethodMap &of_method) {
            return reads(*of_method.method, number.setting()) &&
                   setting_value(of_method.settings, number) !=
                       setting_value(of_method.method->defaults, number);
        });
        const std::string_view name = number.setting().name;
        if (map.x.setting != number && map.y.setting != number &&
            (is_said || name == "dt" || name == "substeps"))
            add(setting_name(number) + " " + values_by_method(map, number));
    }
    add(std::string(precision_name(map.precision)) + " precision");
    add(machine());
    add("commit " + build_commit());
    return text;
}

void write_picture(const MapCommand &command, const StabilityMap &map, std::ostream &err) {
    MapPicture picture{map, theory_of(map, command.options.base), grouped_reasons(map.left_out)};
    picture.footer.insert(picture.footer.end(), map.unjudged.begin(), map.unjudged.end());
    picture.footer.push_back(made_with(map));
    if (!command.command.empty())
        picture.footer.push_back(command.command);
    std::filesystem::path place = command.image;
    const std::string kind = place.extension().string();
    std::filesystem::path partial = place;
    partial.replace_extension(".partial" + kind);
    if (map.interrupted)
        place = partial;
    if (kind == ".svg") {
        OutputFile svg(place);
        write_chart_svg(svg.stream(), picture);
        svg.finish();
    } else {
        write_png(place, ChartPainter(command.shader_dir).paint(picture));
    }
    err << "wrote " << place.string() << '\n';
    if (!map.interrupted)
        std::filesystem::remove(partial);
}

} // namespace

ExitCode map_scene(const MapCommand &command, std::ostream &out, std::ostream &err) {
    const std::optional<SceneText> scene = read_scene(command.scene, err);
    if (!scene)
        return ExitCode::bad_input;

    for (const MapAxis *axis : {&command.x, &command.y})
        if (axis->setting)
            refuse_given(*axis->setting, command.options.base.settings);
    const InterruptGuard interrupt;
    ProgressLine line(err);
    line.show(0, command.scene.string());
    MapOptions options = command.options;
    options.stop = InterruptGuard::requested;
    options.progress = [&](double fraction, const std::string &what) { line.show(fraction, what); };
    // Opened before the work, so that a path that cannot be written to fails immediately.
    std::optional<OutputFile> csv;
    std::optional<PartialTable> earlier;
    std::string fingerprint;
    if (!command.csv.empty()) {
        csv.emplace(command.csv);
        earlier.emplace(csv->partial_place());
        fingerprint = map_fingerprint(*scene, command.x, command.y, options);
        std::istringstream known(earlier->text());
        options.known = read_map_csv(known, fingerprint);
    }
    if (!options.known.cells.empty())
        err << "resuming from " << earlier->place().string() << '\n';
    StabilityMap map = map_scene(*scene, command.x, command.y, options);
    map.fingerprint = fingerprint;
    line.clear();
    if (csv) {
        std::ostringstream rows;
        write_map_csv(rows, map);
        const std::string others = earlier->rows_not_in(rows.str(), map_key_columns(map), "run");
        csv->stream() << rows.str();
        if (map.interrupted) {
            csv->stream() << others;
            err << "interrupted; rows so far: " << csv->keep_partial().string() << '\n';
        } else {
            csv->finish();
            err << "wrote " << csv->path().string() << '\n';
            earlier->keep_only(others);
        }
    }
    if (!command.image.empty())
        write_picture(command, map, err);
    print(out, map); // last, as its reader may close the pipe
    out << std::flush;
    return ExitCode::fine;
}

} // namespace plumb
