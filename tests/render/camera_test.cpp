#include "app/render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/vec4.hpp>

#include "engine/core/random.h"

namespace plumb {
namespace {

constexpr glm::vec2 viewport{1280, 720};

Camera camera_at(float yaw, float pitch) {
    Camera camera;
    camera.target = {1, 2, -3};
    camera.distance = 7;
    camera.yaw = yaw;
    camera.pitch = pitch;
    return camera;
}

std::vector<Camera> cameras() {
    std::vector<Camera> result;
    for (const float yaw : {-2.5f, 0.0f, 0.6f, 3.0f})
        for (const float pitch : {-1.2f, 0.0f, 0.35f, Camera::max_pitch})
            result.push_back(camera_at(yaw, pitch));
    return result;
}

void expect_near(const glm::vec3 &a, const glm::vec3 &b, float tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Camera, YawZeroLooksFromPlusZAndPositivePitchLooksDown) {
    expect_near(camera_at(0, 0).eye(), {1, 2, 4}, 1e-6f);
    EXPECT_GT(camera_at(0, 0.3f).eye().y, 2);
    EXPECT_LT(camera_at(0, 0.3f).forward().y, 0);
    expect_near(camera_at(std::numbers::pi_v<float> / 2, 0).eye(), {8, 2, -3}, 1e-5f);
}

// A few round-offs of numbers up to 10 in single precision.
constexpr float rounding = 1e-5f;

TEST(Camera, MatricesAreThoseOfGlm) {
    for (const Camera &camera : cameras()) {
        const glm::mat4 view = glm::lookAt(camera.eye(), camera.target, glm::vec3(0, 1, 0));
        const glm::mat4 projection =
            glm::perspective(camera.fov, 1.7f, camera.near_plane(), camera.far_plane());
        for (int c = 0; c < 4; ++c) {
            for (int r = 0; r < 4; ++r) {
                // Near the pole lookAt's cross product with "up" loses digits: 1 / cos(89 degrees).
                EXPECT_NEAR(camera.view()[c][r], view[c][r], 57 * rounding);
                EXPECT_NEAR(camera.projection(1.7f)[c][r], projection[c][r], rounding);
            }
        }
    }
}

TEST(Camera, ProjectAgreesWithTheMatricesAndUnprojectUndoesIt) {
    Random random(7);
    for (const Camera &camera : cameras()) {
        const glm::dmat4 view =
            glm::lookAt(glm::dvec3(camera.eye()), glm::dvec3(camera.target), glm::dvec3(0, 1, 0));
        const glm::dmat4 projection = glm::perspective(
            static_cast<double>(camera.fov), static_cast<double>(viewport.x / viewport.y),
            static_cast<double>(camera.near_plane()), static_cast<double>(camera.far_plane()));
        for (int i = 0; i < 100; ++i) {
            const glm::dvec3 world{random.next_in(-3, 5), random.next_in(-2, 6),
                                   random.next_in(-7, 1)};
            const glm::dvec4 clip = projection * view * glm::dvec4(world, 1);
            if (clip.w < 1)
                continue;
            const glm::vec3 seen = camera.project(glm::vec3(world), viewport);
            // Pixels: single-precision round-off at a thousand, times the spread at a depth of 1 m.
            EXPECT_NEAR(static_cast<double>(seen.x), (clip.x / clip.w + 1) / 2 * 1280, 0.02);
            EXPECT_NEAR(static_cast<double>(seen.y), (1 - clip.y / clip.w) / 2 * 720, 0.02);
            EXPECT_NEAR(static_cast<double>(seen.z), (clip.z / clip.w + 1) / 2, 1e-6);
            // One round-off of depth near 1 is 6e-8 and moves the point by depth^2 / near times
            // that: at most 15^2 / 0.07 * 6e-8 = 2e-4 metres, twice for the round trip.
            expect_near(camera.unproject(seen, viewport), glm::vec3(world), 4e-4f);
        }
    }
}

TEST(Camera, PointsBehindTheEyeHaveADepthAboveOne) {
    const Camera camera = camera_at(0.4f, 0.2f);
    EXPECT_GT(camera.project(camera.eye() - camera.forward(), viewport).z, 1);
}

TEST(Camera, PickRayThroughTheCentreIsTheViewAndThroughACornerIsAnalytic) {
    const Camera camera = camera_at(0, 0);
    const PickRay centre = camera.pick_ray({640, 360}, viewport);
    expect_near(centre.direction, {0, 0, -1}, rounding);
    expect_near(centre.origin, camera.eye(), 0);
    const float h = std::tan(camera.fov / 2);
    expect_near(camera.pick_ray({0, 0}, viewport).direction,
                glm::normalize(glm::vec3(-h * 16 / 9, h, -1)), rounding);
}

TEST(Camera, PickRayThroughAProjectedPointMeetsIt) {
    for (const Camera &camera : cameras()) {
        const glm::vec3 point = camera.target + glm::vec3(0.7f, -0.4f, 0.9f);
        const glm::vec3 pixel = camera.project(point, viewport);
        const PickRay ray = camera.pick_ray(glm::vec2(pixel), viewport);
        const glm::vec3 d = point - ray.origin;
        EXPECT_LT(glm::length(glm::cross(d, ray.direction)), 2 * rounding);
    }
}

TEST(Camera, PanKeepsThePointUnderThePointer) {
    for (const Camera &camera : cameras()) {
        const glm::vec3 held = camera.target + 0.5f * camera.right() - 0.3f * camera.up();
        const glm::vec3 before = camera.project(held, viewport);
        Camera panned = camera;
        panned.pan({35, -20}, viewport.y);
        const glm::vec3 after = panned.project(held, viewport);
        EXPECT_NEAR(after.x - before.x, 35, 0.01f);
        EXPECT_NEAR(after.y - before.y, -20, 0.01f);
    }
}

TEST(Camera, OrbitTurnsHalfAroundOverTheViewportAndStopsAtThePoles) {
    Camera camera = camera_at(0.5f, 0);
    camera.orbit({360, 0}, 720);
    EXPECT_NEAR(camera.yaw, 0.5f - std::numbers::pi_v<float> / 2, 1e-6f);
    camera.orbit({0, 5000}, 720);
    EXPECT_FLOAT_EQ(camera.pitch, Camera::max_pitch);
    camera.orbit({0, -9000}, 720);
    EXPECT_FLOAT_EQ(camera.pitch, -Camera::max_pitch);
}

TEST(Camera, ZoomKeepsTheTargetAndUndoesItself) {
    Camera camera = camera_at(0.5f, 0.1f);
    camera.zoom(3);
    EXPECT_LT(camera.distance, 7);
    EXPECT_EQ(camera.target, glm::vec3(1, 2, -3));
    camera.zoom(-3);
    EXPECT_NEAR(camera.distance, 7, rounding);
}

TEST(Camera, FrameShowsTheWholeSphereAndLittleElse) {
    for (const float side : {0.5f, 1.0f, 1.2f}) {
        Camera camera = camera_at(0.7f, 0.5f);
        camera.frame({4, 5, 6}, 2, side);
        EXPECT_EQ(camera.target, glm::vec3(4, 5, 6));
        // The cone tangent to the sphere, against half the square.
        const float cone = std::asin(2 / camera.distance);
        const float half = std::atan(std::tan(camera.fov / 2) * side);
        EXPECT_LT(cone, half);
        EXPECT_GT(cone, 0.9f * half);
    }
    Camera camera;
    camera.frame({0, 0, 0}, 0, 1);
    EXPECT_GT(camera.distance, 0);
}

// A camera that looks through a part of the picture shows there what a camera of the same field of
// view shows in a picture of that size.
TEST(Camera, LooksThroughAPartOfThePicture) {
    const glm::vec2 corner{300, 40};
    const glm::vec2 size{600, 500};
    for (const float aspect : {1.0f, 1.5f}) {
        const float height = std::min(size.y, size.x / aspect);
        for (const Camera &whole : cameras()) {
            Camera part = whole;
            part.look_through(viewport, corner, size, aspect);
            const glm::vec2 shift = corner + 0.5f * (size - glm::vec2(height));
            for (const glm::vec3 offset : {glm::vec3(0), {0.7f, -0.4f, 0.9f}, {-1, 1, 0.5f}}) {
                const glm::vec3 place = whole.target + offset;
                const glm::vec3 small = whole.project(place, glm::vec2(height));
                const glm::vec3 seen = part.project(place, viewport);
                EXPECT_NEAR(seen.x, small.x + shift.x, 0.01f);
                EXPECT_NEAR(seen.y, small.y + shift.y, 0.01f);
                EXPECT_NEAR(seen.z, small.z, 1e-6f);
                // The matrices, the inverse and the ray agree.
                const float ratio = viewport.x / viewport.y;
                const glm::vec4 clip = part.projection(ratio) * part.view() * glm::vec4(place, 1);
                EXPECT_NEAR((clip.x / clip.w + 1) / 2 * viewport.x, seen.x, 0.01f);
                EXPECT_NEAR((1 - clip.y / clip.w) / 2 * viewport.y, seen.y, 0.01f);
                expect_near(part.unproject(seen, viewport), place, 4e-4f);
                const PickRay ray = part.pick_ray(glm::vec2(seen), viewport);
                EXPECT_LT(glm::length(glm::cross(place - ray.origin, ray.direction)), 2e-5f);
            }
            Camera panned = part;
            panned.pan({35, -20}, viewport.y);
            const glm::vec3 moved = panned.project(whole.target, viewport);
            EXPECT_NEAR(moved.x - (corner.x + 0.5f * size.x), 35, 0.01f);
            EXPECT_NEAR(moved.y - (corner.y + 0.5f * size.y), -20, 0.01f);
        }
    }
}

} // namespace
} // namespace plumb
