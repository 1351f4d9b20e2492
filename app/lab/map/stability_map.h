// Where a method holds a scene and where it fails, over two numbers of the scene.
#pragma once

#include "app/lab/exit_code.h"
#include "app/lab/map/failing.h"
#include "app/lab/map/map_axis.h"
#include "app/lab/progress.h"
#include "app/lab/run/scene_text.h"
#include "engine/core/task_pool.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace plumb {

struct MapRun {
    RunFailing failing;
    double time = 0; // s, at the end of the run
    // Of the run; see JudgedRun.
    double max_penetration = 0, max_joint_drift = 0; // m
    double max_energy_gain = 0;
};

// Between two neighbouring cells of a row, one held and one not.
struct MapLimit {
    double y = 0;
    double low = 0, high = 0; // x: one of them held, the other did not
    bool held_below = false;  // at low
    RunFailing failing;       // at the other end
};

struct MethodMap {
    const MethodInfo *method = nullptr;
    std::vector<std::optional<MapRun>> cells; // row by row, the lowest y first; empty: not run
    std::vector<MapLimit> limits;             // row by row, then along x
    StepSettings settings{};                  // but for those on an axis
};

struct StabilityMap {
    SceneDesc scene; // as the file has it
    MapAxis x, y;
    std::vector<MethodMap> methods;
    std::vector<std::string> left_out; // why, of each method that cannot run the scene
    std::vector<std::string> unjudged; // what is expected of bodies that some cells do not have
    Precision precision = Precision::f32;
    std::string fingerprint; // see map_resume.h; may be empty
    bool interrupted = false;

    [[nodiscard]] const std::optional<MapRun> &cell(const MethodMap &map, std::size_t column,
                                                    std::size_t row) const {
        return map.cells[row * x.values.size() + column];
    }
};

// A limit is found to this fraction of the distance between its two cells; of whole numbers, to the
// number.
inline constexpr int limit_halvings = 5;

// What an earlier run of the same map came to, by method and place.
struct KnownRows {
    std::map<std::tuple<std::string, double, double>, MapRun> cells;        // method, x, y
    std::map<std::pair<std::string, double>, std::vector<MapLimit>> limits; // method, y
};

struct MapOptions {
    std::vector<std::string> methods; // empty: all that can run the scene
    RunOptions base;                  // what is not on an axis; its method is not read
    std::optional<double> duration;   // s, of scenes that expect nothing (5)
    std::function<bool()> stop;       // asked often, on any thread; true ends early
    Progress progress;                // called on any thread
    TaskPool *tasks = nullptr;        // null: one thread
    // After each cell, where there is one thread. May be empty.
    std::function<void(const StabilityMap &)> changed;
    KnownRows known; // not run again
};

// Each cell is a run from the start on one thread, so that the map is the same for any number of
// them. Throws std::invalid_argument for axes that the scene has not, values that it refuses, and
// options that make no sense.
[[nodiscard]] StabilityMap map_scene(const SceneText &scene, const MapAxis &x, const MapAxis &y,
                                     const MapOptions &options);

// One row a cell, and one a limit.
void write_map_csv(std::ostream &out, const StabilityMap &map);

// The maps in letters, for people.
void print(std::ostream &out, const StabilityMap &map);

struct MapCommand {
    std::filesystem::path scene;
    MapAxis x, y;
    MapOptions options;               // its stop and progress are set here
    std::filesystem::path image, csv; // empty: none
    std::filesystem::path shader_dir;
    std::string command; // for the footer
};

// Prints to `out`, and everything else to `err`. On Ctrl-C the rows so far stay in CSV.partial,
// from which the same command goes on.
[[nodiscard]] ExitCode map_scene(const MapCommand &command, std::ostream &out, std::ostream &err);

} // namespace plumb
