#include "app/render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/core/check.h"

namespace plumb {

namespace {

constexpr float min_distance = 1e-3f; // metres; closer, single precision shows nothing more
constexpr float max_distance = 1e6f;

void check_viewport(const glm::vec2 &viewport) {
    PLUMB_CHECK(viewport.x > 0 && viewport.y > 0,
                "a viewport must have an area, got " << viewport.x << " x " << viewport.y);
}

} // namespace

glm::vec3 Camera::forward() const {
    return {-std::sin(yaw) * std::cos(pitch), -std::sin(pitch), -std::cos(yaw) * std::cos(pitch)};
}

glm::vec3 Camera::right() const {
    return {std::cos(yaw), 0, -std::sin(yaw)};
}

glm::vec3 Camera::up() const {
    return glm::cross(right(), forward());
}

glm::vec3 Camera::eye() const {
    return target - distance * forward();
}

float Camera::half_height() const {
    return std::tan(0.5f * fov) / share;
}

float Camera::near_plane() const {
    return 0.01f * distance;
}

// Far enough for a wide scene seen from close by; the far to near ratio stays below a few hundred
// thousand down to a distance of a decimetre, which a 24-bit depth buffer can handle.
float Camera::far_plane() const {
    return std::max(1000 * distance, 500.0f);
}

glm::mat4 Camera::view() const {
    const glm::vec3 x = right();
    const glm::vec3 z = -forward();
    const glm::vec3 y = glm::cross(z, x);
    const glm::vec3 e = eye();
    return {{x.x, y.x, z.x, 0},
            {x.y, y.y, z.y, 0},
            {x.z, y.z, z.z, 0},
            {-glm::dot(x, e), -glm::dot(y, e), -glm::dot(z, e), 1}};
}

glm::mat4 Camera::projection(float aspect) const {
    PLUMB_CHECK(aspect > 0, "an aspect must be positive, got " << aspect);
    const float n = near_plane();
    const float f = far_plane();
    const float h = half_height();
    return {{1 / (h * aspect), 0, 0, 0},
            {0, 1 / h, 0, 0},
            {-centre.x, -centre.y, -(f + n) / (f - n), -1},
            {0, 0, -2 * f * n / (f - n), 0}};
}

glm::vec3 Camera::project(const glm::vec3 &world, const glm::vec2 &viewport) const {
    check_viewport(viewport);
    const glm::vec3 d = world - eye();
    const float z = glm::dot(d, forward());
    const float h = half_height() * z;
    const float x = glm::dot(d, right()) / (h * viewport.x / viewport.y) + centre.x;
    const float y = glm::dot(d, up()) / h + centre.y;
    const float n = near_plane();
    const float f = far_plane();
    const float depth = f * (1 - n / z) / (f - n);
    return {0.5f * (1 + x) * viewport.x, 0.5f * (1 - y) * viewport.y, depth};
}

glm::vec3 Camera::unproject(const glm::vec3 &pixel_and_depth, const glm::vec2 &viewport) const {
    check_viewport(viewport);
    const float n = near_plane();
    const float f = far_plane();
    const float z = f * n / (f - pixel_and_depth.z * (f - n));
    const float h = half_height() * z;
    const float x =
        (2 * pixel_and_depth.x / viewport.x - 1 - centre.x) * h * viewport.x / viewport.y;
    const float y = (1 - 2 * pixel_and_depth.y / viewport.y - centre.y) * h;
    return eye() + z * forward() + x * right() + y * up();
}

PickRay Camera::pick_ray(const glm::vec2 &pixel, const glm::vec2 &viewport) const {
    check_viewport(viewport);
    const float h = half_height();
    const float x = (2 * pixel.x / viewport.x - 1 - centre.x) * h * viewport.x / viewport.y;
    const float y = (1 - 2 * pixel.y / viewport.y - centre.y) * h;
    return {eye(), glm::normalize(forward() + x * right() + y * up())};
}

void Camera::orbit(const glm::vec2 &delta, float viewport_height) {
    const float turn = std::numbers::pi_v<float> / viewport_height;
    yaw = std::remainder(yaw - turn * delta.x, 2 * std::numbers::pi_v<float>);
    pitch = std::clamp(pitch + turn * delta.y, -max_pitch, max_pitch);
}

void Camera::pan(const glm::vec2 &delta, float viewport_height) {
    const float metres = 2 * distance * half_height() / viewport_height; // per pixel
    target += metres * (-delta.x * right() + delta.y * up());
}

void Camera::zoom(float notches) {
    distance = std::clamp(distance * std::pow(0.88f, notches), min_distance, max_distance);
}

void Camera::frame(const glm::vec3 &sphere, float radius, float side) {
    PLUMB_CHECK(radius >= 0 && side > 0,
                "cannot frame a radius of " << radius << " in a side of " << side);
    // The sphere touches the square's sides if a tangent from the eye makes half the angle the
    // square spans: sin(half) = radius / distance.
    const float half = std::atan(std::tan(0.5f * fov) * side);
    target = sphere;
    distance =
        std::clamp(1.05f * std::max(radius, 0.01f) / std::sin(half), min_distance, max_distance);
}

void Camera::look_through(const glm::vec2 &viewport, const glm::vec2 &corner, const glm::vec2 &size,
                          float aspect) {
    check_viewport(viewport);
    check_viewport(size);
    PLUMB_CHECK(aspect > 0, "an aspect must be positive, got " << aspect);
    const glm::vec2 middle = (corner + 0.5f * size) / viewport;
    centre = {2 * middle.x - 1, 1 - 2 * middle.y};
    share = std::min(size.y, size.x / aspect) / viewport.y;
}

} // namespace plumb
