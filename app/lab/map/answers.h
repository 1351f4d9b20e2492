// Which expectations a map or chart can judge by: those whose answer its axes do not change.
#pragma once

#include "app/lab/map/map_axis.h"
#include "engine/scene/simulation.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace plumb {

// Whether an axis varies what is solved, and not only how: gravity, or a number of the file other
// than those of a method or an expectation.
[[nodiscard]] bool varies_the_scene(const MapAxis &axis);

// Whether an expectation holds along an axis that varies the scene, whatever its values, by its
// kind alone:
//
//   errors (a bound from 0) of penetration, of the residuals of contacts, of joint drift if no
//   joint is a spring, and of energy gained unless brings_energy_in; along the count of a repeat,
//   any bound: it is meant for any number of copies.
[[nodiscard]] bool holds_whatever(const SceneDesc &scene, const ExpectDesc &expect,
                                  const MapAxis &axis);

struct AnswerOptions {
    // The file's scene with those numbers, a value for each axis.
    std::function<SceneDesc(std::span<const double> at)> scene_at;
    RunOptions base;            // as the map's
    std::function<bool()> stop; // called often; true ends early
};

// The names of the scene's expectations that a map or chart over these axes must not judge by. All
// others hold all over it: they hold whatever it varies, or an accurate run (with 16 substeps, in
// double) meets them at the ends of each axis that varies the scene and at their middle. So a bound
// is kept that can be met throughout, such as a wall that holds whatever is thrown at it, and a
// stated answer that does not depend on the number, such as a pendulum's period on its mass; not a
// period on its length. It errs where an answer is right at three places of an axis and wrong
// between them, and leaves out what the accurate run cannot meet either. If no axis varies the
// scene nothing is run.
[[nodiscard]] std::vector<std::string> outdated_answers(const SceneDesc &scene,
                                                        std::span<const MapAxis> axes,
                                                        const AnswerOptions &options);

// "stated for the file's own gravity.y: "height", "landing""; empty if there are none.
[[nodiscard]] std::string outdated_text(std::span<const MapAxis> axes,
                                        const std::vector<std::string> &outdated);

} // namespace plumb
