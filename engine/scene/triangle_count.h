// Triangle counts of a scene's surfaces. Not for users of the engine.
#pragma once

#include "engine/scene/shape_desc.h"

#include <cstddef>

namespace plumb {

inline std::size_t triangle_count(const MeshDesc &mesh) {
    return mesh.data ? mesh.data->triangles.size() : 0;
}

inline std::size_t triangle_count(const HeightFieldDesc &field) {
    return 2 * static_cast<std::size_t>(field.rows - 1) *
           static_cast<std::size_t>(field.columns - 1);
}

template <typename Solid> std::size_t triangle_count(const Solid & /*shape*/) {
    return 0;
}

} // namespace plumb
