// Data shared by all shaders of a frame.
#pragma once

#include <filesystem>
#include <string>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "app/render/shader_program.h"

namespace plumb {

// The uniform block `Frame` of frame.glsl, std140. Positions in shaders are relative to the
// camera's target, which keeps them small however far the scene is from the origin.
struct FrameBlock {
    glm::mat4 projection;
    glm::mat4 view;
    glm::mat4 shadow;
    glm::vec4 eye;      // xyz; w: the camera's distance
    glm::vec4 to_light; // xyz unit; w: intensity
    glm::vec4 viewport; // width, height, tan of half the field of view across and up
    glm::vec4 light;  // ambient; shadow texel in metres; shadow texel in texture units; shadows on
    glm::vec4 range;  // near, far; edges on; metres per pixel at unit depth
    glm::vec4 centre; // where the target is seen, x and y in clip space
};
inline constexpr unsigned frame_binding = 0;

// Texture units.
inline constexpr unsigned shadow_unit = 1;
inline constexpr unsigned depth_unit = 2;
inline constexpr unsigned occlusion_unit = 3;

// A program that reads the frame's block and textures.
[[nodiscard]] ShaderProgram frame_program(const std::filesystem::path &dir,
                                          const std::string &vertex, const std::string &fragment,
                                          const std::string &definition = {});

// Draws over the whole screen, with a vertex array that has no attributes.
void draw_screen(const ShaderProgram &program, unsigned empty_array);

} // namespace plumb
