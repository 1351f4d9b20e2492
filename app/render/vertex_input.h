// Vertex buffers and their attributes.
#pragma once

#include <cstddef>
#include <span>

namespace plumb {

// Replaces the buffer's contents, and binds it for `attribute`.
void upload(unsigned buffer, std::span<const std::byte> bytes);

// What an attribute reads from the bound buffer: floats, one set per vertex, or per instance with a
// divisor of 1. Sizes in bytes.
void attribute(unsigned index, int components, std::size_t stride, std::size_t offset,
               unsigned divisor);

// An offset into the bound buffer, as OpenGL takes it.
const void *byte_offset(std::size_t bytes);

} // namespace plumb
