#include "app/lab/map/stability_map.h"

#include "app/lab/map/answers.h"
#include "app/lab/map/axis_names.h"
#include "app/lab/map/passage.h"
#include "app/lab/map/standing.h"
#include "app/lab/map/theory.h"
#include "app/lab/run/method_choice.h"
#include "engine/scene/file/change.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

namespace plumb {

namespace {

std::vector<std::string> known_methods() {
    std::vector<std::string> names;
    for (const MethodInfo &method : method_infos())
        names.emplace_back(method.name);
    return names;
}

// The scene and run options at one point of the map, or of a single axis.
class Point {
  public:
    Point(const SceneText &text, const MapAxis &x, const MapAxis *y, const RunOptions &base)
        : text_(text), x_(x), y_(y), base_(base) {}

    SceneDesc scene(double x, double y = 0) const {
        SceneFileResult result = parse(x, y);
        for (const SceneMessage &message : result.messages)
            if (message.severity == SceneMessage::Severity::error)
                throw std::invalid_argument(place(x, y) + ": " + message.what +
                                            (message.suggestion.empty() ? "" : "; ") +
                                            message.suggestion);
        return std::move(result.scene);
    }
    bool is_fine(double x) const { return parse(x, 0).ok(); }

    RunOptions run(const MethodInfo &method, double x, double y) const {
        RunOptions run = base_;
        run.method = std::string(method.name);
        if (x_.setting)
            run.settings.give(*x_.setting, x);
        if (y_ != nullptr && y_->setting)
            run.settings.give(*y_->setting, y);
        return run;
    }

  private:
    SceneFileResult parse(double x, double y) const {
        std::vector<ChangedNumber> changed = text_.changed;
        for (ChangedNumber &number : changed_numbers(x_, x))
            changed.push_back(std::move(number));
        if (y_ != nullptr)
            for (ChangedNumber &number : changed_numbers(*y_, y))
                changed.push_back(std::move(number));
        return parse_scene(text_.text, text_.path.string(), known_methods(), changed);
    }
    std::string place(double x, double y) const {
        const std::string along_x = "with " + x_.name + "=" + value_label(x_, x);
        return y_ == nullptr ? along_x : along_x + " and " + y_->name + "=" + value_label(*y_, y);
    }

    const SceneText &text_;
    const MapAxis &x_, *y_; // y may be null
    const RunOptions &base_;
};

// A number in the file must be whole if the scene rejects a half-integer but accepts whole values.
MapAxis settled(const SceneText &text, const SceneDesc &scene, const MapAxis &given,
                const RunOptions &base) {
    MapAxis axis = named_axis(given, text.text, scene);
    if (axis.setting)
        return axis;
    const std::string world = "world.";
    if (axis.name.starts_with(world) && find_setting(axis.name.substr(world.size())) != nullptr)
        throw std::invalid_argument(axis.name + " is a setting; write " +
                                    axis.name.substr(world.size()));
    const Point point(text, axis, nullptr, base);
    const double low = axis.values.front(), high = axis.values.back();
    const double broken = std::floor(low) + 0.5;
    const bool spans = low <= broken && broken <= high;
    if (spans && !point.is_fine(broken) && point.is_fine(std::ceil(low)) &&
        point.is_fine(std::floor(high)))
        return in_whole_numbers(axis);
    return axis;
}

void refuse_same(const MapAxis &x, const MapAxis &y) {
    if (x.name == y.name)
        throw std::invalid_argument(x.name + " is on both axes");
    for (const ChangedNumber &along_x : changed_numbers(x, x.values.front()))
        for (const ChangedNumber &along_y : changed_numbers(y, y.values.front()))
            if (along_x.path == along_y.path)
                throw std::invalid_argument(along_x.path + " is on both axes: " + x.name + " and " +
                                            y.name);
}

// The scene's expectations that some variants along an axis lack, with the axis values; those
// variants are judged by the rest.
std::vector<std::string> find_unjudged(const SceneText &text, const StabilityMap &map,
                                       const RunOptions &base) {
    std::vector<std::string> unjudged;
    const auto add_along = [&](const MapAxis &axis) {
        if (axis.setting)
            return;
        const Point point(text, axis, nullptr, base);
        std::map<std::string, std::string> where;
        for (const double value : axis.values) {
            const SceneDesc variant = point.scene(value);
            if (variant.expects.empty() && !map.scene.expects.empty())
                throw std::invalid_argument("with " + axis.name + "=" + value_label(axis, value) +
                                            " no expectation is left to judge by: add one that is "
                                            "not of a body that the axis removes");
            for (const ExpectDesc &expect : map.scene.expects)
                if (std::ranges::find(variant.expects, expect.name, &ExpectDesc::name) ==
                    variant.expects.end()) {
                    std::string &values = where[expect.name];
                    values += (values.empty() ? "" : ", ") + value_label(axis, value);
                }
        }
        for (const auto &[name, values] : where)
            unjudged.push_back(std::string("\"")
                                   .append(name)
                                   .append("\" is of a body that does not exist at ")
                                   .append(axis.name)
                                   .append(" = ")
                                   .append(values)
                                   .append(", and is not judged there"));
    };
    add_along(map.x);
    add_along(map.y);
    return unjudged;
}

bool is_outdated(const StabilityMap &map, const ExpectDesc &expect) {
    return std::ranges::find(map.outdated, expect.name) != map.outdated.end();
}

// Finds which expectations no cell can be judged by, and says so.
void find_outdated(StabilityMap &map, const SceneText &text, const MapOptions &options) {
    const Point point(text, map.x, &map.y, options.base);
    const std::array axes{map.x, map.y};
    map.outdated =
        outdated_answers(map.scene, axes,
                         {[&](std::span<const double> at) { return point.scene(at[0], at[1]); },
                          options.base, options.stop});
    if (map.outdated.empty())
        return;
    map.unjudged.push_back("not judged, as it is " + outdated_text(axes, map.outdated));
    if (map.outdated.size() == map.scene.expects.size())
        map.unjudged.push_back("judged only by the limits for scenes that expect nothing");
}

// The scene, and its run's outcomes, without those expectations.
SceneDesc without_outdated(const StabilityMap &map, SceneDesc scene) {
    std::erase_if(scene.expects,
                  [&](const ExpectDesc &expect) { return is_outdated(map, expect); });
    return scene;
}

JudgedRun without_outdated(const StabilityMap &map, JudgedRun run) {
    std::vector<ExpectOutcome> outcomes;
    std::vector<double> drops;
    for (std::size_t i = 0; i < run.outcomes.size(); ++i)
        if (!is_outdated(map, run.outcomes[i].desc)) {
            outcomes.push_back(run.outcomes[i]);
            drops.push_back(run.drops[i]);
        }
    run.outcomes = std::move(outcomes);
    run.drops = std::move(drops);
    return run;
}

// Runs work items on all threads, and reports progress.
class Runner {
  public:
    Runner(const SceneText &text, const StabilityMap &map, const MapOptions &options)
        : point_(text, map.x, &map.y, options.base), map_(map), options_(options) {}

    // nullopt if interrupted.
    std::optional<MapRun> run(const MethodInfo &method, double x, double y) {
        const SceneDesc as_asked = point_.scene(x, y);
        const SceneDesc scene = without_outdated(map_, as_asked);
        const RunOptions run = point_.run(method, x, y);
        const auto simulation = Simulation::create(scene, run, nullptr);
        PassageWatch passage(scene, *simulation);
        std::optional<StandingWatch> standing;
        if (!expects_of_bodies(scene))
            standing.emplace(scene, *simulation);
        JudgeOptions judging;
        judging.follow_errors = true;
        judging.duration = options_.duration.value_or(judging.duration);
        judging.stop = options_.stop;
        int told = 0;
        judging.progress = [&](double fraction) {
            passage.sample(*simulation);
            const int now = static_cast<int>(one_run * fraction);
            if (now > told)
                advance(now - std::exchange(told, now));
        };
        // Runs for as long as the file asks, whatever it is judged by.
        JudgedRun judged = judge_run(*simulation, as_asked, judging);
        if (judged.stopped)
            return std::nullopt;
        judged = without_outdated(map_, std::move(judged));
        advance(one_run - told);
        const std::string fallen =
            standing && !judged.divergence ? standing->fallen(*simulation) : std::string();
        return MapRun{why_failed(scene, judged, passage.first(), fallen), judged.time,
                      judged.max_penetration, judged.max_joint_drift, judged.max_energy_gain};
    }

    // The same for a cell, which is undecided if it held only because it grows too slowly to show.
    std::optional<MapRun> run_cell(const MethodInfo &method, double x, double y) {
        std::optional<MapRun> cell = run(method, x, y);
        if (cell && cell->failing.failing == Failing::none && cell->max_energy_gain > 0) {
            const SceneDesc scene = point_.scene(x, y);
            if (grows_by_theory(scene, resolve_run(scene, point_.run(method, x, y))))
                cell->failing.failing = Failing::undecided;
        }
        return cell;
    }

    // This many of the planned runs are not needed.
    void skip(int runs) { advance(static_cast<std::int64_t>(one_run) * runs); }

    // All items together take about `runs` runs.
    template <typename Item, typename Work>
    void for_each(std::vector<Item> &items, std::size_t runs, double from, double to,
                  const std::string &what, const Work &work) {
        from_ = from;
        to_ = to;
        what_ = map_.scene.name + ": " + what;
        planned_ = static_cast<double>(runs) * one_run;
        done_ = 0;
        advance(0);
        const auto part = [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end && !stopped(); ++i)
                work(items[i]);
        };
        if (options_.tasks != nullptr && options_.tasks->threads() > 1)
            options_.tasks->for_parts(items.size(), 1, part);
        else
            part(0, items.size());
    }

    bool stopped() const { return options_.stop && options_.stop(); }

  private:
    static constexpr int one_run = 1000; // in units of progress

    void advance(std::int64_t units) {
        const auto done = static_cast<double>(done_ += units);
        if (options_.progress)
            options_.progress(from_ + (to_ - from_) * std::min(1.0, done / std::max(1.0, planned_)),
                              what_);
    }

    Point point_;
    const StabilityMap &map_;
    const MapOptions &options_;
    double from_ = 0, to_ = 1, planned_ = 0;
    std::string what_;
    std::atomic<std::int64_t> done_ = 0;
};

struct CellItem {
    MethodMap *map;
    std::size_t column, row;
};

struct LimitItem {
    MethodMap *map;
    MapLimit limit;
    bool done = false;
};

bool is_undecided(const std::optional<MapRun> &run) {
    return run->failing.failing == Failing::undecided;
}

bool held(const std::optional<MapRun> &run) {
    return run->failing.failing == Failing::none;
}

const MapLimit *find_known(const KnownRows &known, const MethodMap &of_method,
                           const MapLimit &limit) {
    const auto row = known.limits.find({std::string(of_method.method->name), limit.y});
    if (row == known.limits.end())
        return nullptr;
    const auto found = std::ranges::find_if(row->second, [&](const MapLimit &each) {
        return each.low >= limit.low && each.high <= limit.high;
    });
    return found == row->second.end() ? nullptr : &*found;
}

std::vector<LimitItem> limits_to_find(StabilityMap &map, const KnownRows &known) {
    std::vector<LimitItem> items;
    for (MethodMap &of_method : map.methods)
        for (std::size_t row = 0; row < map.y.values.size(); ++row)
            for (std::size_t column = 1; column < map.x.values.size(); ++column) {
                const auto &left = map.cell(of_method, column - 1, row);
                const auto &right = map.cell(of_method, column, row);
                if (!left || !right || held(left) == held(right) || is_undecided(left) ||
                    is_undecided(right))
                    continue;
                MapLimit limit{map.y.values[row], map.x.values[column - 1], map.x.values[column],
                               held(left), (held(left) ? right : left)->failing};
                const MapLimit *done = find_known(known, of_method, limit);
                items.push_back({&of_method, done != nullptr ? *done : limit, done != nullptr});
            }
    return items;
}

// Whether so many halvings have brought the ends of a limit close enough.
bool is_narrow(const MapAxis &axis, double low, double high, int halvings) {
    constexpr double resolution = 1e-7; // of the axis
    const double width = high - low;
    if (axis.whole)
        return width <= 1;
    return halvings >= limit_halvings &&
           (width <= limit_accuracy * std::max(std::abs(low), std::abs(high)) ||
            width <= resolution * (axis.values.back() - axis.values.front()));
}

// Bisects the interval between a held and a failing end; false if interrupted.
bool narrow_down(Runner &runner, const MapAxis &axis, LimitItem &item) {
    MapLimit &limit = item.limit;
    for (int i = 0; !is_narrow(axis, limit.low, limit.high, i); ++i) {
        const double middle = between(axis, limit.low, limit.high);
        const std::optional<MapRun> run = runner.run(*item.map->method, middle, limit.y);
        if (!run)
            return false;
        if (held(run) != limit.held_below)
            limit.high = middle;
        else
            limit.low = middle;
        if (!held(run))
            limit.failing = run->failing;
    }
    return true;
}

} // namespace

int runs_to_limit(const MapAxis &x, double low, double high) {
    int runs = 0;
    for (; !is_narrow(x, low, high, runs); ++runs) {
        const double middle = between(x, low, high);
        // Towards 0, where it takes longest.
        (std::abs(low) < std::abs(high) ? high : low) = middle;
    }
    return runs;
}

StabilityMap map_scene(const SceneText &scene, const MapAxis &x, const MapAxis &y,
                       const MapOptions &options) {
    if (options.duration && !(*options.duration > 0))
        throw std::invalid_argument("a run must last longer than 0 s");
    StabilityMap map;
    SceneFileResult as_it_is =
        parse_scene(scene.text, scene.path.string(), known_methods(), scene.changed);
    if (!as_it_is.ok())
        throw std::invalid_argument(scene.path.string() + " is not a valid scene");
    map.scene = std::move(as_it_is.scene);
    if (!has_world(map.scene))
        throw std::invalid_argument("the scene has only probes, no motion to map");
    if (options.duration && !map.scene.expects.empty())
        throw std::invalid_argument("the scene sets its own duration: it runs until the last "
                                    "window of its expectations ends");
    map.x = settled(scene, map.scene, x, options.base);
    map.y = settled(scene, map.scene, y, options.base);
    refuse_same(map.x, map.y);
    for (const MethodInfo *method : methods_for(map.scene, options.methods, map.left_out))
        map.methods.push_back({method, {}, {}});
    for (MethodMap &of_method : map.methods) {
        RunOptions run = options.base;
        run.method = std::string(of_method.method->name);
        const ResolvedRun resolved = resolve_run(map.scene, run);
        of_method.settings = resolved.settings;
        map.precision = resolved.precision;
    }
    if (map.methods.empty())
        throw std::invalid_argument(why_no_method(map.left_out));

    map.unjudged = find_unjudged(scene, map, options.base);
    if (options.progress)
        options.progress(0, map.scene.name + ": what is expected");
    find_outdated(map, scene, options);
    Runner runner(scene, map, options);
    std::vector<CellItem> cells; // those not known
    for (MethodMap &of_method : map.methods) {
        of_method.cells.resize(map.x.values.size() * map.y.values.size());
        for (std::size_t row = 0; row < map.y.values.size(); ++row)
            for (std::size_t column = 0; column < map.x.values.size(); ++column) {
                const auto known = options.known.cells.find(
                    {std::string(of_method.method->name), map.x.values[column], map.y.values[row]});
                if (known != options.known.cells.end())
                    of_method.cells[row * map.x.values.size() + column] = known->second;
                else
                    cells.push_back({&of_method, column, row});
            }
    }
    constexpr double grid_share = 0.7; // of the time; a guess
    runner.for_each(cells, cells.size(), 0, grid_share, "cells", [&](const CellItem &item) {
        item.map->cells[item.row * map.x.values.size() + item.column] =
            runner.run_cell(*item.map->method, map.x.values[item.column], map.y.values[item.row]);
        if (options.changed && options.tasks == nullptr)
            options.changed(map);
    });
    std::vector<LimitItem> limits;
    if (!runner.stopped())
        limits = limits_to_find(map, options.known);
    const auto runs_of = [&](const LimitItem &item) {
        return runs_to_limit(map.x, item.limit.low, item.limit.high);
    };
    std::size_t runs = 0;
    for (const LimitItem &item : limits)
        runs += static_cast<std::size_t>(runs_of(item));
    runner.for_each(limits, runs, grid_share, 1, "limits", [&](LimitItem &item) {
        if (item.done)
            runner.skip(runs_of(item));
        else
            item.done = narrow_down(runner, map.x, item);
    });
    for (const LimitItem &item : limits)
        if (item.done)
            item.map->limits.push_back(item.limit);
    map.interrupted = runner.stopped();
    return map;
}

} // namespace plumb
