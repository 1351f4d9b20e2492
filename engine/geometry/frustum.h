// The view frustum: six planes and eight corners, culling tests, and unprojection from pixels to
// the world.
//
// Clip space is OpenGL's and GLM's default: x, y and z from -w to w. Pixels count from the top left
// corner of the picture, y down, so the centre of the first pixel is (0.5, 0.5).
#pragma once

#include "engine/geometry/shapes.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {

// A closed convex solid with six faces.
struct Frustum {
    enum Face { left, right, bottom, top, near, far };

    // Outward: a point in front of none is inside. In the order of Face.
    std::array<Plane, 6> planes;
    // Corner k is right if k & 1, top if k & 2, far if k & 4.
    std::array<Vec3, 8> corners{};
};

// The part of the world that `view_projection` (projection * view) maps into the clip volume;
// planes after Gribb and Hartmann (2001, "Fast Extraction of Viewing Frustum Planes from the
// World-View-Projection Matrix"). A non-finite or singular matrix fails a check, and so does an
// infinite far plane.
//
// Planes and corners are computed in double, so in float they match the given matrix to 8 epsilon
// times the largest corner coordinate. In double they are off by up to 32 epsilon times that times
// far / near, because the far plane is a small difference. That difference is already rounded when
// the matrix is made, so keep far / near below 1e5 in float.
Frustum frustum_of(const Mat4 &view_projection);

enum class FrustumSide { outside, across, inside };

// Cheap and conservative: `outside` means the whole shape is in front of one plane, `inside` that
// it is behind all six. So a shape outside near an edge or corner may be reported as `across`.
// `outside` and `inside` are reliable, up to roundings of 8 epsilon times the largest coordinate or
// size. For a point the result is as exact as the planes.
FrustumSide classify(const Frustum &frustum, const Vec3 &point);
FrustumSide classify(const Frustum &frustum, const Sphere &sphere);
FrustumSide classify(const Frustum &frustum, const Aabb &box);
FrustumSide classify(const Frustum &frustum, const Box &box);
FrustumSide classify(const Frustum &frustum, const Capsule &capsule);

bool contains(const Frustum &frustum, const Vec3 &point);

// A point inside is its own closest point. Near an edge the error is that of the planes (see
// frustum_of) divided by the sine of the angle between the two faces.
Vec3 closest_point(const Frustum &frustum, const Vec3 &point);

// Exact up to roundings of 32 epsilon times the largest coordinate: by closest point for spheres,
// by separating axes including the frustum's edges (Gottschalk, Lin, Manocha 1996) for boxes. Where
// classify is decisive, its answer is used.
bool overlaps(const Frustum &frustum, const Sphere &sphere);
bool overlaps(const Frustum &frustum, const Aabb &box);
bool overlaps(const Frustum &frustum, const Box &box);

// Where the picture lies in the window, in pixels.
struct Viewport {
    Vec2 origin{Real(0)};
    Vec2 size{Real(1)};
};

// The world point drawn at `pixel` with `depth` (0 near, 1 far, as in the depth buffer). An empty
// viewport, a non-finite value, or a point at infinity fails a check. For distant points rounding
// errors grow by far / near; far from the origin, build the inverse as inverse view times inverse
// projection.
Vec3 unproject(const Vec2 &pixel, Real depth, const Mat4 &inverse_view_projection,
               const Viewport &viewport);

// The ray through all points drawn at `pixel`, from the near plane (t = 0) to the far plane (t =
// max_t = 1).
Ray pick_ray(const Vec2 &pixel, const Mat4 &inverse_view_projection, const Viewport &viewport);

} // namespace plumb::inline PLUMB_PRECISION
