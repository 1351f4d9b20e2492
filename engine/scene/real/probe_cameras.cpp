// Camera probes: what a frustum contains, and what lies under a pixel.
#include "engine/scene/real/probe_asking.h"

#include "engine/core/check.h"
#include "engine/geometry/frustum.h"
#include "engine/math/matrices.h"
#include "engine/space/orthtree.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Mat4 view_projection(const ProbeCameraDesc &camera) {
    const Vec3 eye{camera.eye};
    const Vec3 target{camera.target};
    // Straight up or down, "up" is -z.
    const Vec3 along = glm::normalize(target - eye);
    const Vec3 up = std::abs(along.y) < Real(0.999) ? Vec3{Real(0), Real(1), Real(0)}
                                                    : Vec3{Real(0), Real(0), Real(-1)};
    const auto near = static_cast<Real>(camera.near);
    const auto far = static_cast<Real>(camera.far);
    const auto aspect = static_cast<Real>(camera.aspect);
    Mat4 projection{Real(1)};
    if (camera.height) {
        const Real half = Real(0.5) * static_cast<Real>(*camera.height);
        projection = glm::ortho(-half * aspect, half * aspect, -half, half, near, far);
    } else {
        projection = glm::perspective(static_cast<Real>(camera.fov), aspect, near, far);
    }
    return projection * glm::lookAt(eye, target, up);
}

void draw_frustum(Asking &ask, const Frustum &frustum) {
    const auto corner = [&](int i) { return wide(frustum.corners[static_cast<std::size_t>(i)]); };
    for (int i = 0; i < 8; ++i)
        for (const int bit : {1, 2, 4})
            if ((i & bit) == 0)
                ask.answer.lines.push_back({corner(i), corner(i | bit), ProbeTone::query});
    // The near face stands for the picture; a tick marks its top.
    const glm::dvec3 top = 0.5 * (corner(2) + corner(3));
    ask.answer.lines.push_back(
        {top, top + 0.25 * (top - 0.5 * (corner(0) + corner(1))), ProbeTone::query});
    const glm::dvec3 &eye = ask.probe.camera->eye;
    ask.answer.points.push_back({eye, ProbeTone::query});
    if (!ask.probe.camera->height)
        for (int i = 0; i < 4; ++i)
            ask.answer.lines.push_back({eye, corner(i), ProbeTone::faint});
}

constexpr std::array side_tones{ProbeTone::no, ProbeTone::partly, ProbeTone::yes};

} // namespace

void answer_frustum(Asking &ask) {
    const Frustum frustum = frustum_of(view_projection(*ask.probe.camera));
    std::array<std::size_t, 3> sides{};
    for (std::size_t s = 0; s < ask.shapes.size(); ++s) {
        const FrustumSide side = std::visit(
            [&](const auto &shape) -> FrustumSide {
                if constexpr (requires { classify(frustum, shape); })
                    return classify(frustum, shape);
                else
                    PLUMB_CHECK(false, "this kind of shape cannot be classified by a frustum");
            },
            ask.shapes[s].shape);
        ++sides[static_cast<std::size_t>(side)];
        ask.draw(s, side_tones[static_cast<std::size_t>(side)]);
    }
    for (const glm::dvec3 &point : ask.probe.points) {
        const auto side = static_cast<std::size_t>(classify(frustum, Vec3{point}));
        ++sides[side];
        ask.answer.points.push_back({point, side_tones[side]});
    }
    draw_frustum(ask, frustum);
    ask.count("inside", sides[2]);
    ask.count("across", sides[1]);
    ask.count("outside", sides[0]);
}

void answer_cull(Asking &ask) {
    const Frustum frustum = frustum_of(view_projection(*ask.probe.camera));
    const ProbeScatterDesc &scatter = *ask.probe.scatter;
    const std::vector<Aabb> items = scattered_boxes(scatter);
    const glm::dvec3 half = scatter.half_extents + scatter.size;
    Octree tree(Aabb{Vec3{scatter.center - half}, Vec3{scatter.center + half}}, 6, 8);
    for (std::size_t i = 0; i < items.size(); ++i)
        tree.insert(items[i], static_cast<std::uint32_t>(i));
    std::vector<bool> seen(items.size(), false);
    std::size_t tested = 0;
    tree.query_if(
        [&](const Aabb &box) {
            ++tested;
            return classify(frustum, box) != FrustumSide::outside;
        },
        [&](std::uint32_t item) {
            seen[item] = true;
            return true;
        });
    std::size_t count = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const bool is_across = seen[i] && classify(frustum, items[i]) == FrustumSide::across;
        count += seen[i] ? 1 : 0;
        draw_item(ask, items[i],
                  is_across ? ProbeTone::partly
                  : seen[i] ? ProbeTone::yes
                            : ProbeTone::no);
    }
    draw_frustum(ask, frustum);
    ask.answer.labels.push_back(
        {ask.probe.camera->eye,
         std::to_string(count) + " of " + std::to_string(items.size()) + " seen"});
    ask.count("items", items.size());
    ask.count("seen", count);
    ask.count("culled", items.size() - count);
    ask.count("tested", tested);
}

void answer_pick(Asking &ask) {
    const ProbeCameraDesc &camera = *ask.probe.camera;
    const Mat4 matrix = view_projection(camera);
    const std::optional<Mat4> inverse = try_inverse(matrix);
    PLUMB_CHECK(inverse.has_value(), "the camera's matrix has no inverse");
    const Viewport viewport{Vec2{Real(0)}, Vec2{static_cast<Real>(100 * camera.aspect), Real(100)}};
    const Vec2 pixel{*camera.pixel};
    const Ray ray = pick_ray(pixel, *inverse, viewport);
    const ProbeRayDesc asked{wide(ray.origin), wide(ray.direction), 1.0, {}};
    std::optional<RayFound> first;
    std::size_t first_shape = 0;
    for (std::size_t s = 0; s < ask.shapes.size(); ++s) {
        const std::optional<RayFound> found = ray_into(ask.shapes[s].shape, asked);
        if (found && (!first || found->t < first->t)) {
            first = found;
            first_shape = s;
        }
    }
    for (std::size_t s = 0; s < ask.shapes.size(); ++s)
        ask.draw(s, first && s == first_shape ? ProbeTone::yes : ProbeTone::plain);
    draw_frustum(ask, frustum_of(matrix));
    ask.flag("hit", first.has_value());
    const glm::dvec3 end = first ? first->point : asked.origin + asked.direction;
    ask.answer.lines.push_back({camera.eye, end, ProbeTone::result, true, true});
    ask.answer.points.push_back({asked.origin, ProbeTone::result});
    if (!first)
        return;
    ask.answer.points.push_back({first->point, ProbeTone::result, first->normal});
    ask.count("shape", first_shape);
    ask.number("distance", glm::distance(first->point, camera.eye));
    ask.vector(first->point);
    // Back to the picture: where the point is drawn.
    const Vec4 clip = matrix * Vec4{Vec3{first->point}, Real(1)};
    const Vec2 drawn = Real(0.5) * (Vec2{clip.x, -clip.y} / clip.w + Real(1)) * viewport.size;
    ask.number("pixel_x", drawn.x);
    ask.number("pixel_y", drawn.y);
}

} // namespace plumb::inline PLUMB_PRECISION
