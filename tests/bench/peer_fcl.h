// FCL's queries, to time against ours.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"

#include <cstdint>
#include <functional>
#include <span>

namespace plumb::fcl_peer {

using Work = std::function<std::uint64_t()>;

// fcl::collide without contacts: yes or no, in float, with its default solver (libccd).
template <typename A, typename B> Work overlaps(std::span<const A> a, std::span<const B> b);

// fcl::distance with nearest points, unsigned.
template <typename A, typename B> Work distances(std::span<const A> a, std::span<const B> b);

} // namespace plumb::fcl_peer
