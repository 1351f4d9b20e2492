// Simpler models of a scene that still meet its expectations, tried once its settings are found.
#pragma once

#include "app/lab/tune/tune.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// The parts of a model that can be left out, in the order tried. The only list of them: each has a
// case in about() and in simplifications(). Sleep, a setting, comes first, so that the settings
// written into the scene were tried with the bodies as they are.
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

// One thing left out of the model.
struct Simplification {
    std::string what; // what is left out, worded to follow "without"
    std::function<void(SceneDesc &, RunOptions &)> apply;
    bool must_pay = false; // only left out if that is cheaper, not merely no dearer
    bool is_all =
        false; // covers its whole part: the part's other simplifications are left out with it
};

// Its name in a list: "sleep".
[[nodiscard]] std::string_view about(ModelPart part);
// The list of all: "sleep, collisions and rotation".
[[nodiscard]] std::string model_parts_text();

// What could be left out of this scene for that part, in the order tried: sleep; all collisions
// between bodies, else those of each body, unless contacts are expected; each dynamic body's
// rotation; and its shape, replaced by a sphere of the same volume. The copies of a `repeat` count
// as one body.
[[nodiscard]] std::vector<Simplification> simplifications(ModelPart part, const SceneDesc &scene,
                                                          const RunOptions &options);

// Tries each simplification with the chosen settings, from the same starts and on top of those
// already accepted. It is accepted if the scene still meets its expectations and is not dearer by
// more than same_cost in every round; for collisions, only if it is cheaper by that much.
void leave_out(const std::vector<SceneDesc> &starts, const TuneOptions &options, Tuning &tuning,
               const Progress &progress);

} // namespace plumb
