// What a scene can do without, once its settings are found.
#pragma once

#include "app/lab/tune/tune.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// What of a model can be plainer, in the order in which it is tried. The only list of them: each
// has a case in about() and in simplifications(). Sleep, a setting, comes first: what is written
// into the scene was then tried with the bodies as they are.
#define PLUMB_MODEL_PARTS(PART) PART(sleep) PART(collisions) PART(rotation) PART(shape)

enum class ModelPart {
#define PLUMB_MODEL_PART(name) name,
    PLUMB_MODEL_PARTS(PLUMB_MODEL_PART)
#undef PLUMB_MODEL_PART
};

inline constexpr ModelPart all_model_parts[]{
#define PLUMB_MODEL_PART(name) ModelPart::name,
    PLUMB_MODEL_PARTS(PLUMB_MODEL_PART)
#undef PLUMB_MODEL_PART
};

// One thing less to model.
struct Simplification {
    std::string what; // that is left out, after "without"
    std::function<void(SceneDesc &, RunOptions &)> apply;
    bool must_pay = false; // left out only where that is cheaper, not merely no dearer
    bool is_all = false;   // of its part: the others of it are left out with it
};

// "sleep": what it is, in a list.
[[nodiscard]] std::string_view about(ModelPart part);
// The list of all: "sleep, collisions and rotation".
[[nodiscard]] std::string model_parts_text();

// What this scene has of that part that could be left out, in the order in which it is tried:
// sleep; all collisions between bodies, else those of each body, unless something is expected of
// contacts; of each dynamic body its rotation, and its shape for a sphere of the same volume. The
// copies of a `repeat` count as one body.
[[nodiscard]] std::vector<Simplification> simplifications(ModelPart part, const SceneDesc &scene,
                                                          const RunOptions &options);

// Tries each with the chosen settings, from the same starts and on top of those that were left out
// before. Left out is what the scene meets its expectations without, and which does not make it
// dearer in every turn by more than same_cost; collisions where it makes it cheaper by that.
void leave_out(const std::vector<SceneDesc> &starts, const TuneOptions &options, Tuning &tuning,
               const Progress &progress);

} // namespace plumb
