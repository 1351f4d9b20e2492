// Where a method holds a scene and where it fails, over two of the scene's numbers.
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
    double time = 0; // s, when the run ended
    // Over the run; see JudgedRun.
    double max_penetration = 0, max_joint_drift = 0; // m
    double max_energy_gain = 0;
};

// The limit between two neighbouring cells of a row, one that held and one that failed; none
// beside an undecided one.
struct MapLimit {
    double y = 0;
    double low = 0, high = 0; // x: the scene held at one and failed at the other
    bool held_below = false;  // held at low
    RunFailing failing;       // at the failing end
};

struct MethodMap {
    const MethodInfo *method = nullptr;
    std::vector<std::optional<MapRun>> cells; // row by row, the lowest y first; empty: not run
    std::vector<MapLimit> limits;             // row by row, then along x
    StepSettings settings{};                  // except those on an axis
};

struct StabilityMap {
    SceneDesc scene; // as in the file
    MapAxis x, y;
    std::vector<MethodMap> methods;
    std::vector<std::string> left_out; // why each of these methods cannot run the scene
    // The scene's expectations that no cell is judged by, as an axis changes their answer, by name;
    // see outdated_answers. Cells are held to the limits of scenes without them.
    std::vector<std::string> outdated;
    // For people: those, and expectations on bodies that some cells do not have.
    std::vector<std::string> unjudged;
    Precision precision = Precision::f32;
    std::string fingerprint; // see map_resume.h; may be empty
    bool interrupted = false;

    [[nodiscard]] const std::optional<MapRun> &cell(const MethodMap &map, std::size_t column,
                                                    std::size_t row) const {
        return map.cells[row * x.values.size() + column];
    }
};

// Limits are bisected until their ends are this close, as a fraction of the larger end's magnitude
// (near 0, until they are a ten-millionth of the axis apart); whole numbers until they are
// neighbours. On fine grids, where that takes fewer, limit_halvings times.
inline constexpr double limit_accuracy = 0.0025;
inline constexpr int limit_halvings = 5;

// How many runs it takes at most to find the limit between two neighbouring values of the axis.
[[nodiscard]] int runs_to_limit(const MapAxis &x, double low, double high);

// Results of an earlier run of the same map, by method and place.
struct KnownRows {
    std::map<std::tuple<std::string, double, double>, MapRun> cells;        // method, x, y
    std::map<std::pair<std::string, double>, std::vector<MapLimit>> limits; // method, y
};

struct MapOptions {
    std::vector<std::string> methods; // empty: all that can run the scene
    RunOptions base;                  // settings not on an axis; its method is not read
    std::optional<double> duration;   // s, for scenes without expectations (default 5)
    std::function<bool()> stop;       // called often, on any thread; true ends early
    Progress progress;                // called on any thread
    TaskPool *tasks = nullptr;        // null: one thread
    // Called after each cell if there is one thread. May be empty.
    std::function<void(const StabilityMap &)> changed;
    KnownRows known; // not run again
};

// Each cell is a run from the start on one thread, so the map does not depend on the thread count.
// Throws std::invalid_argument for axes the scene does not have, values it refuses, and invalid
// options.
[[nodiscard]] StabilityMap map_scene(const SceneText &scene, const MapAxis &x, const MapAxis &y,
                                     const MapOptions &options);

// One row per cell and one per limit.
void write_map_csv(std::ostream &out, const StabilityMap &map);

// Prints the maps as letters.
void print(std::ostream &out, const StabilityMap &map);

struct MapCommand {
    std::filesystem::path scene;
    MapAxis x, y;
    MapOptions options;               // stop and progress are set by the command
    std::filesystem::path image, csv; // empty: none
    std::filesystem::path shader_dir;
    std::string command; // for the footer
};

// Prints to `out`, and everything else to `err`. On Ctrl-C the rows so far stay in CSV.partial, and
// the same command resumes from there.
[[nodiscard]] ExitCode map_scene(const MapCommand &command, std::ostream &out, std::ostream &err);

} // namespace plumb
