// The chart and the stability map of the running scene, made in the background.
#pragma once

#include "app/lab/chart/chart.h"
#include "app/lab/map/stability_map.h"
#include "app/sandbox/session/session.h"
#include "app/sandbox/studies/background.h"

#include <optional>
#include <string>

namespace plumb {

using ChartStudy = Background<SceneChart>;
// A map of one method, and what its cells ran with apart from the values on the axes.
struct MethodStudy {
    StabilityMap map;
    StepSettings settings;
    SceneText text;
};
using MapStudy = Background<MethodStudy>;

// Charts all methods that can run the scene, over these sweeps ("substeps=1..16 dt=1/240..1/60"),
// with the gravity, step and precision of the session's run. Throws std::invalid_argument for
// meaningless sweeps.
void start_chart(ChartStudy &study, const Session &session, const std::string &sweeps);

// Maps the current method with the current settings, over two axes in the syntax of parse_map_axis.
// Throws std::invalid_argument the same way.
void start_map(MapStudy &study, const Session &session, const std::string &x, const std::string &y);

// How to continue the running scene.
struct RunChoice {
    std::string method;
    StepSettings settings;
    std::optional<SceneDesc> scene; // restart with this scene instead of the running one
    SceneText text;                 // text of that scene
    // How a whole run with it fared: how it failed, a phrase, or empty if it held; nullopt if that
    // is not known.
    std::optional<std::string> failure;
};

[[nodiscard]] RunChoice choice_of(const ChartRun &run);
// The cell's values. Values that are numbers in the scene's file take effect by restarting with a
// scene that has them.
[[nodiscard]] RunChoice choice_of(const MethodStudy &study, double x, double y);

} // namespace plumb
