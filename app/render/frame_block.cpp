#include "app/render/frame_block.h"

#include <glad/gl.h>

namespace plumb {

ShaderProgram frame_program(const std::filesystem::path &dir, const std::string &vertex,
                            const std::string &fragment, const std::string &definition) {
    ShaderProgram program(dir, vertex, fragment, definition);
    program.bind_block("Frame", frame_binding);
    program.bind_sampler("shadow_map", static_cast<int>(shadow_unit));
    program.bind_sampler("depth_map", static_cast<int>(depth_unit));
    program.bind_sampler("occlusion_map", static_cast<int>(occlusion_unit));
    return program;
}

void draw_screen(const ShaderProgram &program, unsigned empty_array) {
    program.use();
    glBindVertexArray(empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace plumb
