// How much a probe asks for, in terms of the limits of probe_desc.h. Not for users of the engine.
#pragma once

#include "engine/scene/probe_desc.h"

#include <cstddef>

namespace plumb {

struct ProbeSize {
    std::size_t shapes = 0;    // including parts of compounds
    std::size_t triangles = 0; // of meshes and height fields
    std::size_t scattered = 0;
    std::size_t questions = 0; // shape and point pairs, or shape pairs
};
ProbeSize size_of(const ProbeDesc &probe);

} // namespace plumb
