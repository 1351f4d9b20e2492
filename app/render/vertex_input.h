// What vertex shaders read: buffers, and the attributes in them.
#pragma once

#include <cstddef>
#include <span>

namespace plumb {

// Replaces what the buffer holds, and binds it for `attribute`.
void upload(unsigned buffer, std::span<const std::byte> bytes);

// What an attribute reads of the buffer bound: floats, one set for each vertex, or with a divisor
// of 1 for each instance. Sizes in bytes.
void attribute(unsigned index, int components, std::size_t stride, std::size_t offset,
               unsigned divisor);

// An offset into the buffer bound, as OpenGL takes it.
const void *byte_offset(std::size_t bytes);

} // namespace plumb
