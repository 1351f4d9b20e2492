// FCL's answers, to be timed beside ours.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"

#include <cstdint>
#include <functional>
#include <span>

namespace plumb::fcl_peer {

using Work = std::function<std::uint64_t()>;

// fcl::collide without contacts: yes or no. In float, with the solver that is its default (libccd).
template <typename A, typename B> Work overlaps(std::span<const A> a, std::span<const B> b);

// fcl::distance, with nearest points, not signed.
template <typename A, typename B> Work distances(std::span<const A> a, std::span<const B> b);

} // namespace plumb::fcl_peer
