// The seam between a world and the methods that advance it.
#pragma once

#include "engine/dynamics/body.h"
#include "engine/dynamics/contact.h"
#include "engine/dynamics/joint.h"
#include "engine/dynamics/method_info.h"
#include "engine/dynamics/settings.h"

#include <span>
#include <string_view>

namespace plumb::inline PLUMB_PRECISION {

// What a method is given: the world's state, to be advanced by settings.dt. Contacts hold the
// manifolds of the poses at the start of the step; removed bodies and joints are holes (alive ==
// false).
struct StepContext {
    const StepSettings &settings;
    std::span<const Body> bodies;
    std::span<Motion> motions;
    std::span<Contact> contacts;
    std::span<Joint> joints;
    Motion &world_frame; // stands for the world in joints: it never moves

    // What the method reports.
    std::uint32_t impacts = 0;
    std::uint32_t unresolved_impacts = 0;

    Motion &motion(std::uint32_t body) {
        return body == Joint::world ? world_frame : motions[body];
    }
};

using AdvanceFunction = void (*)(StepContext &);

// One row of the registry: what a method says about itself, and its whole inner loop.
struct Method {
    MethodInfo info;
    AdvanceFunction advance = nullptr;
};

// All methods, in the order in which they are listed everywhere (methods/registry.cpp).
std::span<const Method> methods();

// Null when there is none of that name.
const Method *find_method(std::string_view name);

} // namespace plumb::inline PLUMB_PRECISION
