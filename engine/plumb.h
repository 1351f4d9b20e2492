// Plumb's engine, whole. The types that compute motion are in float; define PLUMB_DOUBLE before the
// first include (for a whole program: target_compile_definitions) to have them in double.
// Simulation takes its precision from the scene, and is the same type in both.
#pragma once

#include "engine/core/check.h"
#include "engine/core/hash.h"
#include "engine/core/precision.h"
#include "engine/core/random.h"
#include "engine/core/task_pool.h"
#include "engine/dynamics/measures.h"
#include "engine/dynamics/method_info.h"
#include "engine/dynamics/settings.h"
#include "engine/dynamics/step_report.h"
#include "engine/dynamics/world.h"
#include "engine/geometry/closest.h"
#include "engine/geometry/manifold.h"
#include "engine/geometry/mass.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/sat.h"
#include "engine/geometry/shapes.h"
#include "engine/math/types.h"
#include "engine/scene/expect.h"
#include "engine/scene/scene_desc.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"
#include "engine/space/dynamic_tree.h"
