// The chart and the stability map of the running scene, made beside the play.
#pragma once

#include "app/lab/chart/chart.h"
#include "app/lab/map/stability_map.h"
#include "app/sandbox/session/session.h"
#include "app/sandbox/studies/background.h"

#include <optional>
#include <string>

namespace plumb {

using ChartStudy = Background<SceneChart>;
// A map of one method, and what its cells ran with but for what is on the axes.
struct MethodStudy {
    StabilityMap map;
    StepSettings settings;
    SceneText text;
};
using MapStudy = Background<MethodStudy>;

// Of all methods that can run the scene, over these sweeps ("substeps=1..16 dt=1/240..1/60"), with
// the gravity, step and precision of the session's run. Throws std::invalid_argument for sweeps
// that say nothing.
void start_chart(ChartStudy &study, const Session &session, const std::string &sweeps);

// Of the running method with the running settings, over two axes as parse_map_axis reads them.
// Throws std::invalid_argument likewise.
void start_map(MapStudy &study, const Session &session, const std::string &x, const std::string &y);

// How the running scene is to go on.
struct RunChoice {
    std::string method;
    StepSettings settings;
    std::optional<SceneDesc> scene; // begin with this one, in place of the running one
    SceneText text;                 // of that scene
};

[[nodiscard]] RunChoice choice_of(const ChartRun &run);
// The cell's values; numbers of the scene's file take effect from the start of a scene that has
// them.
[[nodiscard]] RunChoice choice_of(const MethodStudy &study, double x, double y);

} // namespace plumb
