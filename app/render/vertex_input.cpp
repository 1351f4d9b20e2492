#include "app/render/vertex_input.h"

#include <glad/gl.h>

namespace plumb {

void upload(unsigned buffer, std::span<const std::byte> bytes) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
                 GL_STREAM_DRAW);
}

void attribute(unsigned index, int components, std::size_t stride, std::size_t offset,
               unsigned divisor) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                          byte_offset(offset));
    glVertexAttribDivisor(index, divisor);
}

const void *byte_offset(std::size_t bytes) {
    return reinterpret_cast<const void *>(bytes);
}

} // namespace plumb
