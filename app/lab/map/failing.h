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
    missed
};

struct FailingInfo {
    Failing failing;
    std::string_view name;    // "passed through"; in tables
    char letter;              // in a cell
    unsigned colour;          // 0xrrggbb
    std::string_view meaning; // for people
};

// All of them; where a run failed in several ways, the first counts.
[[nodiscard]] std::span<const FailingInfo> failings();
[[nodiscard]] const FailingInfo &info_of(Failing failing);
[[nodiscard]] std::optional<Failing> find_failing(std::string_view name);

// How far a run may go that expects nothing of itself in that.
inline constexpr double tolerated_energy_gain = 0.1; // of K0 + |U0|
inline constexpr double tolerated_depth = 0.25;      // of the smallest width of a moving body

// By a motor, a spring's joint or a moving kinematic body: then more of it is no failing.
[[nodiscard]] bool brings_energy_in(const SceneDesc &scene);

// How deep contacts may be and how far joints may drift (m), in a run that comes to rest so;
// infinite where the scene says itself how far, and drift of springs.
struct ToleratedDepths {
    double penetration = 0, drift = 0;
};
[[nodiscard]] ToleratedDepths tolerated_depths(const SceneDesc &scene);

struct RunFailing {
    Failing failing = Failing::none;
    std::string what; // the missed expectation, the body that is not finite, "ball through wall"
    friend bool operator==(const RunFailing &, const RunFailing &) = default;
};

// Why the run failed. It must have followed its errors; `passage` is what PassageWatch says of it.
//
// What a scene expects comes before what is asked of all: of a scene that has an expectation on its
// penetration only that counts, and so for drift and energy. Energy is not asked of a scene that
// brings some in: by a motor, a spring, a moving kinematic body. Missed expectations go by their
// quantity: on energy as energy_grew when there is too much of it, on penetration and joint_drift
// as these; a body that is to stay above or upright and does not fell; one that is to be slower
// than it is never rests; all others are missed.
[[nodiscard]] RunFailing why_failed(const SceneDesc &scene, const JudgedRun &run,
                                    const std::string &passage);

} // namespace plumb
