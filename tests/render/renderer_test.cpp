#include "app/render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include "app/render/palette.h"
#include "engine/core/check.h"
#include "tests/render/off_screen.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

constexpr glm::ivec2 size{320, 240};

int difference(const glm::u8vec3 &a, const glm::u8vec3 &b) {
    int most = 0;
    for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(static_cast<int>(a[c]) - static_cast<int>(b[c])));
    return most;
}

int sum(const glm::u8vec3 &c) {
    return c.x + c.y + c.z;
}

DrawShape shape(DrawKind kind, glm::vec3 position, glm::vec3 extent,
                glm::vec3 colour = {0.8f, 0.2f, 0.1f}) {
    DrawShape result;
    result.kind = kind;
    result.position = position;
    result.size = extent;
    result.colour = colour;
    return result;
}

TEST_F(OffScreen, AnEmptyListIsTheBackdropWhateverTheCamera) {
    DrawList list;
    const Image first = render_image(renderer, list, size);
    EXPECT_EQ(first.width, size.x);
    EXPECT_EQ(first.height, size.y);
    // Bright, and changing slowly from the top to the middle.
    EXPECT_GT(sum(first.at(160, 120)), 3 * 200);
    EXPECT_GT(difference(first.at(160, 2), first.at(160, 120)), 10);
    for (int y = 1; y < size.y; ++y)
        EXPECT_LE(difference(first.at(160, y), first.at(160, y - 1)), 3);
    list.camera.yaw = 2;
    list.camera.pitch = -0.4f;
    EXPECT_EQ(render_image(renderer, list, size), first);
}

DrawList mixture() {
    DrawList list;
    list.planes.push_back({});
    for (int i = 0; i < 24; ++i) {
        DrawShape s = shape(static_cast<DrawKind>(i % 3),
                            {-3 + 0.3f * static_cast<float>(i), 0.6f, static_cast<float>(i % 5)},
                            {0.4f, 0.3f, 0.5f}, palette_colour(static_cast<std::size_t>(i)));
        s.rotation = glm::angleAxis(0.4f * static_cast<float>(i), glm::vec3(0.6f, 0, 0.8f));
        s.selected = i == 4;
        s.highlighted = i == 5;
        list.shapes.push_back(s);
    }
    list.lines.push_back({{-2, 0.1f, 0}, {2, 3, 0}, colours::joint, 3});
    list.points.push_back({{0, 1, 1}, {0, 0.4f, 0}, colours::contact, 5});
    return list;
}

TEST_F(OffScreen, TheSameListGivesTheSamePixels) {
    const DrawList list = mixture();
    const Image first = render_image(renderer, list, size);
    (void)render_image(renderer, DrawList{}, {100, 50});
    EXPECT_EQ(render_image(renderer, list, size), first);
    Renderer other(shader_dir());
    EXPECT_EQ(render_image(other, list, size), first);
}

TEST_F(OffScreen, AFarOriginGivesNearlyTheSamePixels) {
    DrawList list = mixture();
    const Image here = render_image(renderer, list, size);
    // Multiples of the grid's 10 metres, where quarters of a metre are still exact.
    const glm::vec3 there{10240, 0, -20480};
    list.camera.target += there;
    for (DrawShape &s : list.shapes)
        s.position = there + glm::round(s.position * 256.0f) / 256.0f;
    for (DrawLine &line : list.lines) {
        line.a += there;
        line.b += there;
    }
    list.points[0].position += there;
    const Image far = render_image(renderer, list, size);
    int changed = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            changed += difference(here.at(x, y), far.at(x, y)) > 12;
    // Poses move by up to 2 mm, a fifteenth of a pixel here: only edge pixels may change.
    EXPECT_LT(changed, size.x * size.y / 100);
}

// Compares the picture with an analytic silhouette. `inside` tells how far inside the outline a
// pixel's ray passes, in metres at the shape (negative: outside).
void expect_silhouette(Renderer &renderer, const DrawList &list,
                       const std::function<double(const PickRay &)> &inside) {
    DrawList empty = list;
    empty.shapes.clear();
    const Image without = render_image(renderer, empty, size);
    const Image with = render_image(renderer, list, size);
    const Camera &camera = list.camera;
    // Pixel size at the target's depth.
    const double pixel =
        static_cast<double>(2 * camera.distance * std::tan(camera.fov / 2)) / size.y;
    int covered = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const double depth = inside(camera.pick_ray(
                {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, glm::vec2(size)));
            // The mesh lies inside the shape by less than a third of a pixel; allow half.
            if (std::abs(depth) < 0.5 * pixel)
                continue;
            const bool drawn = difference(with.at(x, y), without.at(x, y)) > 20;
            EXPECT_EQ(drawn, depth > 0) << "pixel " << x << ", " << y;
            covered += drawn;
        }
    }
    EXPECT_GT(covered, 30);
}

// Distance from a ray to a segment, in double precision by bisection on the segment: the distance
// to the ray's line is convex along it.
double distance_to_segment(const PickRay &ray, const glm::dvec3 &a, const glm::dvec3 &b) {
    const auto at = [&](double t) {
        const glm::dvec3 d = a + t * (b - a) - glm::dvec3(ray.origin);
        return glm::length(glm::cross(d, glm::dvec3(ray.direction)));
    };
    double low = 0;
    double high = 1;
    for (int i = 0; i < 100; ++i) {
        const double third = (high - low) / 3;
        if (at(low + third) < at(high - third))
            high -= third;
        else
            low += third;
    }
    return at(low);
}

TEST_F(OffScreen, ASphereHasItsAnalyticSilhouette) {
    for (const float radius : {0.1f, 0.8f, 2.0f}) {
        DrawList list = plain_list();
        list.camera.target = {0, 0, 0};
        list.camera.distance = 8;
        // Off-centre, where the outline is an ellipse.
        const glm::vec3 centre{1.2f, 0.7f, 0};
        list.shapes.push_back(shape(DrawKind::sphere, centre, glm::vec3(radius)));
        expect_silhouette(renderer, list, [&](const PickRay &ray) {
            return static_cast<double>(radius) -
                   distance_to_segment(ray, glm::dvec3(centre), glm::dvec3(centre));
        });
    }
}

TEST_F(OffScreen, ACapsuleHasItsAnalyticSilhouetteAndHeight) {
    for (const float half_height : {0.0f, 0.5f, 1.5f}) {
        DrawList list = plain_list();
        list.camera.target = {0, 0, 0};
        list.camera.distance = 8;
        DrawShape capsule = shape(DrawKind::capsule, {0.3f, 0.2f, 0.1f}, {0.4f, half_height, 0});
        capsule.rotation = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 0.5f, 2)));
        list.shapes.push_back(capsule);
        const glm::dvec3 axis(capsule.rotation * glm::vec3(0, half_height, 0));
        const glm::dvec3 centre(capsule.position);
        expect_silhouette(renderer, list, [&](const PickRay &ray) {
            return 0.4 - distance_to_segment(ray, centre - axis, centre + axis);
        });
    }
}

TEST_F(OffScreen, ABoxCoversItsProjectedCorners) {
    DrawList list = plain_list();
    list.camera.target = {0, 0, 0};
    list.camera.yaw = 0;
    list.camera.pitch = 0;
    list.camera.distance = 8;
    const glm::vec3 half{1.1f, 0.7f, 0.5f};
    list.shapes.push_back(shape(DrawKind::box, {0, 0, 0}, half));
    // Seen head-on: the near face is a rectangle.
    expect_silhouette(renderer, list, [&](const PickRay &ray) {
        const double t = static_cast<double>((half.z - ray.origin.z) / ray.direction.z);
        const glm::dvec3 hit = glm::dvec3(ray.origin) + t * glm::dvec3(ray.direction);
        return std::min(static_cast<double>(half.x) - std::abs(hit.x),
                        static_cast<double>(half.y) - std::abs(hit.y));
    });
}

double srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
double linear(double s) {
    return s > 0.04045 ? std::pow((s + 0.055) / 1.055, 2.4) : s / 12.92;
}

TEST_F(OffScreen, AFlatLitPatchShowsItsColourTimesTheLight) {
    for (const int samples : {1, 4}) {
        for (const float ambient : {1.0f, 0.5f, 0.1f}) {
            DrawList list = plain_list();
            list.camera.target = {0, 0, 0};
            list.camera.pitch = 1.2f;
            list.camera.distance = 5;
            list.light.intensity = 0;
            list.light.ambient = ambient;
            const glm::vec3 colour{0.9f, 0.5f, 0.1f};
            list.shapes.push_back(shape(DrawKind::box, {0, -1, 0}, glm::vec3(1), colour));
            const glm::u8vec3 seen = render_image(renderer, list, size, samples).at(160, 120);
            for (int c = 0; c < 3; ++c)
                // Dithering and rounding contribute half a level each.
                EXPECT_NEAR(seen[c],
                            255 * srgb(static_cast<double>(ambient) *
                                       linear(static_cast<double>(colour[c]))),
                            1.01);
        }
    }
}

TEST_F(OffScreen, DirectLightFollowsTheCosine) {
    for (const float angle : {0.0f, 0.6f, 1.1f}) {
        DrawList list = plain_list();
        list.camera.target = {0, 0, 0};
        list.camera.pitch = 1.2f;
        list.camera.distance = 5;
        // Lit from behind the camera, with no specular highlight towards it.
        list.light.direction = {std::sin(angle), -std::cos(angle), 0};
        list.light.ambient = 0;
        list.light.intensity = 1;
        list.shapes.push_back(shape(DrawKind::box, {0, -1, 0}, glm::vec3(1), glm::vec3(0.5f)));
        const double seen = linear(render_image(renderer, list, size).at(160, 120).x / 255.0);
        // The specular term adds at most a tenth of the light, the sheen almost none from above.
        const double diffuse = linear(0.5) * static_cast<double>(std::cos(angle));
        EXPECT_GT(seen, diffuse - 0.005);
        EXPECT_LT(seen, diffuse + 0.1 * static_cast<double>(std::cos(angle)) + 0.01);
    }
}

// A ball over a floor, with the default light: the shadowed points of the floor are known.
TEST_F(OffScreen, ShadowsLieWhereTheLightIsBlockedAndNowhereElse) {
    DrawList list;
    list.view.occlusion = false;
    list.view.grid = false;
    list.planes.push_back({});
    list.camera.target = {0, 0.5f, 0};
    list.camera.pitch = 0.9f;
    const glm::vec3 centre{0, 1.5f, 0};
    const float radius = 0.8f;
    list.shapes.push_back(shape(DrawKind::sphere, centre, glm::vec3(radius)));
    list.shapes.push_back(shape(DrawKind::box, {2.5f, 0.5f, 0}, glm::vec3(0.5f)));
    const Image with = render_image(renderer, list, size);
    list.view.shadows = false;
    const Image without = render_image(renderer, list, size);
    const glm::vec3 to_light = -glm::normalize(list.light.direction);
    int dark = 0;
    int lit = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const PickRay ray = list.camera.pick_ray(
                {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, glm::vec2(size));
            const glm::vec3 ground = ray.origin - ray.origin.y / ray.direction.y * ray.direction;
            // Skip the box and everything near its shadow; the ball is tested below.
            const bool ball_in_front =
                distance_to_segment(ray, glm::dvec3(centre), glm::dvec3(centre)) <
                static_cast<double>(radius) + 0.1;
            if (ray.direction.y >= 0 || ball_in_front || ground.x > 1.4f || ground.x < -4)
                continue;
            const float away = glm::length(glm::cross(centre - ground, to_light));
            const int darker = sum(without.at(x, y)) - sum(with.at(x, y));
            // The filter softens the edge by a few texels; the map is a few metres wide.
            if (away < radius - 0.1f) {
                EXPECT_GT(darker, 60) << ground.x << ", " << ground.z;
                ++dark;
            } else if (away > radius + 0.1f) {
                EXPECT_LE(std::abs(darker), 3) << ground.x << ", " << ground.z;
                ++lit;
            }
        }
    }
    EXPECT_GT(dark, 200);
    EXPECT_GT(lit, 2000);
}

TEST_F(OffScreen, LitSurfacesShowNoAcne) {
    // Tops and sides that face the light, unobstructed.
    for (const float distance : {6.0f, 60.0f}) {
        DrawList list;
        list.view.occlusion = false;
        list.camera.target = {0, 0.5f, 0};
        list.camera.distance = distance;
        list.camera.yaw = 0;
        const float k = distance / 6;
        list.shapes.push_back(shape(DrawKind::box, {0, k, 0}, {1.5f * k, k, k}, glm::vec3(0.7f)));
        const Image with = render_image(renderer, list, size);
        list.view.shadows = false;
        const Image without = render_image(renderer, list, size);
        int different = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                different += difference(with.at(x, y), without.at(x, y)) > 2;
        // Only the thin rounded rims may change, where the face itself turns away from the light.
        EXPECT_LT(different, 40);
    }
}

// A convex shape casts no shadow on itself, however low the light and however coarse its mesh.
TEST_F(OffScreen, AConvexShapeAloneIsTheSameWithAndWithoutShadows) {
    const float pi = glm::pi<float>();
    Renderer plain(shader_dir(), Renderer::Quality::plain);
    for (const DrawKind kind :
         {DrawKind::sphere, DrawKind::box, DrawKind::capsule, DrawKind::cylinder}) {
        for (const float distance : {4.0f, 12.0f, 30.0f, 70.0f}) { // each picks its own mesh
            for (const float height : {0.1f, 0.3f, 0.7f, 1.2f}) {
                for (const float around : {0.0f, 1.0f}) {
                    for (Renderer *each : {&renderer, &plain}) {
                        DrawList list;
                        list.view.occlusion = false;
                        list.camera = {{0, 0, 0}, distance, around - 0.3f * pi, 0.3f, 0.8f};
                        list.light.direction = {-std::cos(height) * std::sin(around),
                                                -std::sin(height),
                                                -std::cos(height) * std::cos(around)};
                        list.shapes.push_back(shape(kind, {0, 0, 0}, {1, 0.8f, 0.6f}));
                        const Image with = render_image(*each, list, size);
                        list.view.shadows = false;
                        const Image without = render_image(*each, list, size);
                        int darker = 0;
                        for (int y = 0; y < size.y; ++y)
                            for (int x = 0; x < size.x; ++x)
                                darker += difference(with.at(x, y), without.at(x, y)) > 6;
                        EXPECT_LE(darker, 0)
                            << "kind " << static_cast<int>(kind) << " from " << distance
                            << " m, light " << height << " rad high, plain " << (each == &plain);
                    }
                }
            }
        }
    }
}

TEST_F(OffScreen, TheNearerShapeIsSeenInAnyOrder) {
    for (const bool near_first : {true, false}) {
        DrawList list = plain_list();
        list.light = {{0, -1, 0}, 0, 1};
        list.camera = {{0, 0, 0}, 8, 0, 0, 0.8f};
        DrawShape near = shape(DrawKind::sphere, {0, 0, 1}, glm::vec3(0.3f), {1, 0, 0});
        DrawShape far = shape(DrawKind::box, {0, 0, -1}, glm::vec3(1), {0, 0, 1});
        list.shapes = near_first ? std::vector{near, far} : std::vector{far, near};
        const glm::u8vec3 seen = render_image(renderer, list, size).at(160, 120);
        EXPECT_GT(seen.x, 150);
        EXPECT_LT(seen.z, 30);
    }
}

TEST_F(OffScreen, ShapesThatAreNotFiniteAreLeftOut) {
    DrawList list = mixture();
    const Image without = render_image(renderer, list, size);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    list.shapes.push_back(shape(DrawKind::box, {nan, 0, 0}, glm::vec3(1)));
    list.shapes.push_back(shape(DrawKind::sphere, {0, infinity, 0}, glm::vec3(1)));
    list.lines.push_back({{0, 0, 0}, {nan, 1, 0}, {1, 0, 0}, 2});
    list.points.push_back({{0, -infinity, 0}, {0, 1, 0}, {1, 0, 0}, 2});
    EXPECT_EQ(render_image(renderer, list, size), without);
}

TEST_F(OffScreen, LinesAreAsWideAsTheySay) {
    for (const float width : {1.0f, 2.0f, 5.0f}) {
        DrawList list = plain_list();
        list.camera = {{0, 0, 0}, 8, 0, 0, 0.8f};
        const Image without = render_image(renderer, list, size);
        list.lines.push_back({{-1, 0.03f, 0}, {1, 0.03f, 0}, {0, 0, 0}, width});
        const Image with = render_image(renderer, list, size);
        // Light blocked down a column through its middle: the width, since each pixel's coverage
        // follows from the distance of its centre.
        double covered = 0;
        for (int y = 0; y < size.y; ++y) {
            const double before = linear(without.at(160, y).x / 255.0);
            covered += 1 - linear(with.at(160, y).x / 255.0) / before;
        }
        EXPECT_NEAR(covered, static_cast<double>(width), 0.05);
        // Not past its ends.
        const glm::vec3 end = list.camera.project({1, 0.03f, 0}, glm::vec2(size));
        const int past = static_cast<int>(end.x + width / 2) + 2;
        for (int y = 0; y < size.y; ++y)
            EXPECT_EQ(with.at(past, y), without.at(past, y));
    }
}

TEST_F(OffScreen, LinesThatPassTheEyeAreCutAtTheNearPlane) {
    DrawList list = plain_list();
    list.camera = {{0, 0, 0}, 8, 0, 0, 0.8f};
    const Image without = render_image(renderer, list, size);
    // Along the view axis and slightly below it, from behind the eye to far away.
    list.lines.push_back({{0, -0.5f, 20}, {0, -0.5f, -1000}, {0, 0, 0}, 3});
    const Image with = render_image(renderer, list, size);
    EXPECT_NE(with.at(160, 200), without.at(160, 200));
    for (int y = 0; y < 110; ++y) // above the horizon
        for (int x = 0; x < size.x; ++x)
            EXPECT_EQ(with.at(x, y), without.at(x, y));
    // Wholly behind the eye: nothing is drawn.
    list.lines = {{{0, -0.5f, 20}, {3, 0.5f, 9}, {0, 0, 0}, 3}};
    EXPECT_EQ(render_image(renderer, list, size), without);
}

TEST_F(OffScreen, HiddenLinesShowFaintly) {
    DrawList list = plain_list();
    list.camera = {{0, 0, 0}, 8, 0, 0, 0.8f};
    list.light = {{0, -1, 0}, 0, 1};
    list.shapes.push_back(shape(DrawKind::box, {0, 0, 0}, {1, 1, 0.1f}, glm::vec3(0.8f)));
    const int plain = sum(render_image(renderer, list, size).at(160, 120));
    list.lines.push_back({{-2, 0, -1}, {2, 0, -1}, {0, 0, 0}, 7});
    const int hidden = sum(render_image(renderer, list, size).at(160, 120));
    list.lines[0] = {{-2, 0, 1}, {2, 0, 1}, {0, 0, 0}, 7};
    const int seen = sum(render_image(renderer, list, size).at(160, 120));
    EXPECT_LT(hidden, plain - 30);
    EXPECT_GT(hidden, plain / 2);
    EXPECT_LT(seen, 12);
}

TEST_F(OffScreen, ASelectedShapeHasARingEvenWhenHidden) {
    DrawList list = plain_list();
    list.camera = {{0, 0, 0}, 8, 0, 0, 0.8f};
    list.shapes.push_back(shape(DrawKind::sphere, {0, 0, -1}, glm::vec3(0.5f)));
    list.shapes.push_back(shape(DrawKind::box, {0, 0, 1}, {1, 1, 0.1f}, glm::vec3(0.5f)));
    const Image without = render_image(renderer, list, size);
    list.shapes[0].selected = true;
    const Image with = render_image(renderer, list, size);
    const auto accent = glm::u8vec3(colours::selected * 255.0f + 0.5f);
    int ring = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            if (with.at(x, y) == without.at(x, y))
                continue;
            EXPECT_LE(difference(with.at(x, y), accent), 1);
            ++ring;
        }
    }
    // Roughly the sphere's circumference in pixels times the ring's three.
    const double radius = 0.5 / 9 * 120 / static_cast<double>(std::tan(0.4f));
    EXPECT_NEAR(ring, 3 * 2 * 3.14159 * (radius + 1.5), 0.2 * ring);
    EXPECT_EQ(with.at(160, 120), without.at(160, 120));
}

TEST_F(OffScreen, WireframeLetsTheBackdropThrough) {
    DrawList list = plain_list();
    list.camera = {{0, 0, 0}, 8, 0, 0, 0.8f};
    const Image empty = render_image(renderer, list, size);
    list.shapes.push_back(shape(DrawKind::box, {0, 0, 0}, glm::vec3(1)));
    const auto covered = [&] {
        const Image image = render_image(renderer, list, size);
        int count = 0;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                count += image.at(x, y) != empty.at(x, y);
        return count;
    };
    const int filled = covered();
    list.view.wireframe = true;
    const int wires = covered();
    EXPECT_GT(wires, 100);
    EXPECT_LT(wires, filled / 5);
}

TEST_F(OffScreen, APlaneIsNotSeenFromBelowAndFadesIntoTheBackdrop) {
    DrawList list = plain_list();
    const Image empty = render_image(renderer, list, size);
    list.planes.push_back({});
    list.camera.pitch = -0.4f;
    list.camera.target = {0, -3, 0};
    EXPECT_EQ(render_image(renderer, list, size), empty);
    list.camera.target = {0, 1, 0};
    list.camera.pitch = 0.15f;
    const Image floor = render_image(renderer, list, size);
    int changed = 0;
    for (int x = 0; x < size.x; ++x) {
        changed += floor.at(x, 200) != empty.at(x, 200);
        // The horizon lies tan(pitch) / tan(fov / 2) above the middle; nothing may be left there.
        const int horizon =
            static_cast<int>(120 * (1 - std::tan(0.15f) / std::tan(list.camera.fov / 2)));
        EXPECT_LE(difference(floor.at(x, horizon + 1), empty.at(x, horizon + 1)), 3);
    }
    EXPECT_GT(changed, 200);
}

TEST_F(OffScreen, OcclusionDarkensCreasesOnly) {
    DrawList list;
    list.view.shadows = false;
    list.view.grid = false;
    list.planes.push_back({});
    list.camera.target = {0, 0.5f, 0};
    list.camera.yaw = 0;
    list.shapes.push_back(shape(DrawKind::box, {0, 0.5f, 0}, glm::vec3(0.5f)));
    const Image with = render_image(renderer, list, size);
    list.view.occlusion = false;
    const Image without = render_image(renderer, list, size);
    const auto darker = [&](const glm::vec3 &world) {
        const glm::vec3 pixel = list.camera.project(world, glm::vec2(size));
        const int x = static_cast<int>(pixel.x);
        const int y = static_cast<int>(pixel.y);
        return sum(without.at(x, y)) - sum(with.at(x, y));
    };
    EXPECT_GT(darker({0, 0, 0.6f}), 25);       // on the floor, by the box's foot
    EXPECT_LE(std::abs(darker({0, 0, 3})), 2); // on the open floor
    EXPECT_LE(std::abs(darker({0, 1, 0})), 2); // on top
    EXPECT_LE(std::abs(darker({-4, 0, -0.5f})), 2);
}

TEST_F(OffScreen, MultisamplingOnlySoftensEdges) {
    const DrawList list = mixture();
    const Image one = render_image(renderer, list, size, 1);
    const Image four = render_image(renderer, list, size, 4);
    int much = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            much += difference(one.at(x, y), four.at(x, y)) > 16;
    EXPECT_GT(much, 50);
    EXPECT_LT(much, size.x * size.y / 12);
}

TEST_F(OffScreen, FramebuffersRefuseImpossibleSizesAndResize) {
    EXPECT_THROW(Framebuffer({0, 10}), std::runtime_error);
    EXPECT_THROW(Framebuffer({1 << 20, 10}), std::runtime_error);
    EXPECT_THROW(Framebuffer({10, 10}, 0), CheckFailure);
    Framebuffer target({64, 48});
    const DrawList list = mixture();
    renderer.draw(list, target);
    target.resize(size);
    renderer.draw(list, target);
    EXPECT_EQ(target.read(), render_image(renderer, list, size));
    const glm::ivec2 odd{31, 17};
    EXPECT_EQ(render_image(renderer, list, odd).width, 31);
}

TEST_F(OffScreen, AnImpossibleCameraOrLightIsRefused) {
    DrawList list;
    Framebuffer target({8, 8});
    list.camera.distance = 0;
    EXPECT_THROW(renderer.draw(list, target), CheckFailure);
    list = DrawList{};
    list.light.direction = glm::vec3(0);
    EXPECT_THROW(renderer.draw(list, target), CheckFailure);
}

TEST_F(OffScreen, ShaderErrorsNameFileAndLine) {
    const TemporaryFolder folder;
    const std::filesystem::path dir = folder.path() / "broken_shaders";
    const auto message = [&] {
        try {
            Renderer broken(dir);
        } catch (const std::runtime_error &error) {
            return std::string(error.what());
        }
        return std::string("nothing thrown");
    };
    EXPECT_NE(message().find("broken_shaders"), std::string::npos);
    std::filesystem::copy(shader_dir(), dir);
    int lines = 0;
    {
        std::ifstream in(dir / "lighting.glsl");
        for (std::string line; std::getline(in, line);)
            ++lines;
        std::ofstream(dir / "lighting.glsl", std::ios::app) << "float wrong = nonsense;\n";
    }
    EXPECT_NE(message().find("lighting.glsl:" + std::to_string(lines + 1)), std::string::npos)
        << message();
    std::filesystem::remove(dir / "dither.glsl");
    EXPECT_NE(message().find("dither.glsl: cannot read"), std::string::npos) << message();
}

} // namespace
} // namespace plumb
