#include "app/sandbox/studies/studies.h"

#include "engine/scene/file/change.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace plumb {

namespace {

// Few, so that a first answer comes soon; the command line takes more.
constexpr int repeats = 3;

std::optional<std::string> failure_of(const ChartRun &run) {
    switch (run.status) {
    case ChartStatus::fine:
        return "";
    case ChartStatus::outside:
        return run.worst ? "it misses \"" + run.run.outcomes[*run.worst].desc.name + "\""
                         : "it misses an expectation";
    case ChartStatus::diverged:
        return "it diverged";
    case ChartStatus::no_result:
    case ChartStatus::unfinished:
        break;
    }
    return std::nullopt;
}

// Of the map's cell at these values.
std::optional<std::string> failure_of(const StabilityMap &map, double x, double y) {
    const auto at = [](const MapAxis &axis, double value) {
        return static_cast<std::size_t>(std::ranges::find(axis.values, value) -
                                        axis.values.begin());
    };
    const std::size_t column = at(map.x, x), row = at(map.y, y);
    if (column >= map.x.values.size() || row >= map.y.values.size())
        return std::nullopt;
    const std::optional<MapRun> &cell = map.cell(map.methods.front(), column, row);
    if (!cell)
        return std::nullopt;
    const RunFailing &failing = cell->failing;
    if (failing.failing == Failing::none)
        return "";
    return std::string(info_of(failing.failing).name) +
           (failing.what.empty() ? "" : " (" + failing.what + ")");
}

template <typename Wanted>
void give_running(GivenSettings &settings, const Simulation &simulation, const Wanted &wanted) {
    for (const SettingNumber number : setting_numbers())
        if (wanted(number.setting()))
            settings.give(number, setting_value(simulation.settings(), number));
}

} // namespace

void start_chart(ChartStudy &study, const Session &session, const std::string &sweeps) {
    const Simulation &simulation = *session.simulation();
    ChartOptions options;
    std::istringstream words(sweeps);
    for (std::string word; words >> word;)
        add_sweep(options, word);
    static_cast<void>(sweep_points(options.sweep));
    options.repeats = repeats;
    options.timed = 1;
    options.base = session.options();
    options.base.method.clear();
    options.base.precision = simulation.precision();
    give_running(options.base.settings, simulation, [](const SettingRow &row) {
        return row.group == SettingGroup::world || row.member == SettingMember(&StepSettings::dt);
    });
    study.start([scene = session.scene(), options](ChartStudy::Desk &desk) {
        ChartOptions mine = options;
        mine.stop = [&] { return desk.stopped(); };
        mine.progress = [&](double done, const std::string &) { desk.set_done(done); };
        desk.publish(
            chart_scene(scene, mine, [&](const SceneChart &chart) { desk.publish(chart); }));
    });
}

void start_map(MapStudy &study, const Session &session, const std::string &x,
               const std::string &y) {
    const Simulation &simulation = *session.simulation();
    const MapAxis along_x = parse_map_axis(x);
    const MapAxis along_y = parse_map_axis(y);
    if (along_x.name == along_y.name)
        throw std::invalid_argument(along_x.name + " is on both axes");
    MapOptions options;
    options.methods = {std::string(simulation.method().name)};
    options.base.precision = simulation.precision();
    give_running(options.base.settings, simulation,
                 [&](const SettingRow &row) { return reads(simulation.method(), row); });
    study.start([text = session.scene_text(), along_x, along_y, options,
                 settings = simulation.settings()](MapStudy::Desk &desk) {
        MapOptions mine = options;
        mine.stop = [&] { return desk.stopped(); };
        mine.progress = [&](double done, const std::string &) { desk.set_done(done); };
        mine.changed = [&](const StabilityMap &map) { desk.publish({map, settings, text}); };
        desk.publish({map_scene(text, along_x, along_y, mine), settings, text});
    });
}

RunChoice choice_of(const ChartRun &run) {
    return {std::string(run.resolved.method->name), run.resolved.settings, {}, {}, failure_of(run)};
}

RunChoice choice_of(const MethodStudy &study, double x, double y) {
    const StabilityMap &map = study.map;
    RunChoice choice{std::string(map.methods.front().method->name),
                     study.settings,
                     {},
                     study.text,
                     failure_of(map, x, y)};
    bool any_changed = false;
    for (const auto &[axis, value] : {std::pair(&map.x, x), std::pair(&map.y, y)})
        if (axis->setting) {
            set_setting(choice.settings, *axis->setting, value);
        } else {
            for (const ChangedNumber &changed : changed_numbers(*axis, value)) {
                std::erase_if(choice.text.changed, [&](const ChangedNumber &number) {
                    return number.path == changed.path;
                });
                choice.text.changed.push_back(changed);
            }
            any_changed = true;
        }
    if (any_changed) // the map ran it, so it is a valid scene
        choice.scene =
            parse_scene(choice.text.text, choice.text.path.string(), {}, choice.text.changed).scene;
    return choice;
}

} // namespace plumb
