// The orbit camera: right-handed, Y up, yaw 0 looks from +z, positive pitch looks down.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace plumb {

// A ray through a pixel, from the camera's eye; unit direction.
struct PickRay {
    glm::vec3 origin{0};
    glm::vec3 direction{0, 0, -1};
};

// Positions are in the draw list's frame; metres, radians. The pixel origin is the top left, y
// down; the centre of the first pixel is (0.5, 0.5). A `viewport` is a size in pixels.
struct Camera {
    glm::vec3 target{0, 1, 0};
    float distance = 10; // from the target to the eye, > 0
    float yaw = 0.6f;    // about +y
    float pitch = 0.35f; // kept within max_pitch of the horizon, so "up" stays defined
    float fov = 0.8f;    // the full vertical angle, in (0, pi)
    // When part of the picture is covered, the camera looks through the rest: the target appears at
    // `centre`, from (-1, -1) at the lower left to (1, 1), and `fov` spans this share of the
    // picture's height.
    glm::vec2 centre{0};
    float share = 1;

    static constexpr float max_pitch = 1.5533f; // 89 degrees

    [[nodiscard]] glm::vec3 eye() const;
    [[nodiscard]] glm::vec3 forward() const; // unit, from the eye to the target
    [[nodiscard]] glm::vec3 right() const;   // unit
    [[nodiscard]] glm::vec3 up() const;      // unit, the picture's up

    // Half of the whole picture's height at unit depth.
    [[nodiscard]] float half_height() const;

    // The near and far planes scale with the distance, so depth stays usable at every scale.
    [[nodiscard]] float near_plane() const;
    [[nodiscard]] float far_plane() const;

    [[nodiscard]] glm::mat4 view() const;
    [[nodiscard]] glm::mat4 projection(float aspect) const; // OpenGL clip space, z in [-1, 1]

    // World to pixel: x and y in pixels, z the window depth in [0, 1]. A point in the eye's plane
    // gives infinities; one behind the eye gives a depth above 1.
    [[nodiscard]] glm::vec3 project(const glm::vec3 &world, const glm::vec2 &viewport) const;
    // The inverse of `project`.
    [[nodiscard]] glm::vec3 unproject(const glm::vec3 &pixel_and_depth,
                                      const glm::vec2 &viewport) const;
    [[nodiscard]] PickRay pick_ray(const glm::vec2 &pixel, const glm::vec2 &viewport) const;

    // Mouse operations. Deltas are in pixels of a viewport `viewport_height` high.
    // Dragging over the viewport's height orbits half a turn.
    void orbit(const glm::vec2 &delta, float viewport_height);
    // The point at the target's depth stays under the pointer.
    void pan(const glm::vec2 &delta, float viewport_height);
    // In mouse wheel notches; positive comes nearer. The target stays.
    void zoom(float notches);
    // Keeps yaw, pitch and fov, and fits the whole sphere into a square of this side, in units of
    // the height that fov spans. A radius below a centimetre counts as one centimetre.
    void frame(const glm::vec3 &sphere, float radius, float side);
    // Sets `centre` and `share` to look through a rectangle of the picture (pixels, from the top
    // left): the field of view is as large as it can be with a picture of this aspect (width over
    // height) inside the rectangle.
    void look_through(const glm::vec2 &viewport, const glm::vec2 &corner, const glm::vec2 &size,
                      float aspect);
};

} // namespace plumb
