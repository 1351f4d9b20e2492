// Why a run failed: the colours of a stability map.
#pragma once

#include "app/lab/run/judged_run.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace plumb {

enum class Failing {
    none,
    not_finite,
    passed_through,
    energy_grew,
    penetration,
    drift,
    fell,
    never_rests,
    missed,
    undecided // held as long as it ran, but theory says that it will not for ever
};

struct FailingInfo {
    Failing failing;
    std::string_view name;    // "passed through"; in tables
    char letter;              // in a cell
    unsigned colour;          // 0xrrggbb
    std::string_view meaning; // for people
};

// All of them; if a run failed in several ways, the first in this order counts. Undecided is
// never why_failed's answer; see grows_by_theory.
[[nodiscard]] std::span<const FailingInfo> failings();
[[nodiscard]] const FailingInfo &info_of(Failing failing);
[[nodiscard]] std::optional<Failing> find_failing(std::string_view name);

// Limits for runs whose scene has no expectation of that kind.
inline constexpr double tolerated_energy_gain = 0.1; // of K0 + |U0|
inline constexpr double tolerated_depth = 0.25;      // of the smallest width of any moving body

// Whether a motor, a spring joint, a constant torque or a moving kinematic body adds energy: then
// gaining energy is no failure.
[[nodiscard]] bool brings_energy_in(const SceneDesc &scene);

// Whether the scene expects anything of a body: where it is, how fast, how far tilted.
[[nodiscard]] bool expects_of_bodies(const SceneDesc &scene);

// Largest penetration and joint drift (m) tolerated at the end of a run; infinite if the scene has
// its own expectation, and for drift if it has spring joints.
struct ToleratedDepths {
    double penetration = 0, drift = 0;
};
[[nodiscard]] ToleratedDepths tolerated_depths(const SceneDesc &scene);

struct RunFailing {
    Failing failing = Failing::none;
    std::string what; // the missed expectation, the body that is not finite, "ball through wall"
    friend bool operator==(const RunFailing &, const RunFailing &) = default;
};

// Why the run failed. Requires JudgeOptions::follow_errors; `passage` is PassageWatch::first(),
// `fallen` StandingWatch::fallen() at the end of the run: the body that should stand and does not.
//
// A scene's own expectations replace the general limits: if it has one on penetration, only that
// counts; the same goes for drift and energy, and `fallen` counts only if none is about a body. The
// general energy limit does not apply if brings_energy_in. Missed expectations are classified by
// quantity: too much energy is energy_grew; penetration and joint_drift map to their namesakes; a
// body that does not stay above a height or upright fell, as did one that left its place mostly
// downwards; one that is faster than allowed never rests; all others are missed.
[[nodiscard]] RunFailing why_failed(const SceneDesc &scene, const JudgedRun &run,
                                    const std::string &passage, const std::string &fallen = {});

} // namespace plumb
