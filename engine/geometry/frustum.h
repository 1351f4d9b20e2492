// The view frustum: six planes and eight corners, what is in it, and the way from a pixel to the
// world.
//
// Clip space is OpenGL's and GLM's default: x, y and z from -w to w. A pixel is counted from the
// top left corner of the picture, y down, so the middle of the first pixel is (0.5, 0.5).
#pragma once

#include "engine/geometry/shapes.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {

// A closed convex solid with six faces.
struct Frustum {
    enum Face { left, right, bottom, top, near, far };

    // Outward: a point is inside when it is in front of none. In the order of Face.
    std::array<Plane, 6> planes;
    // Corner k is right if k & 1, top if k & 2, far if k & 4.
    std::array<Vec3, 8> corners{};
};

// The part of the world that `view_projection` (projection * view) carries into the clip volume;
// its planes by Gribb and Hartmann (2001, "Fast Extraction of Viewing Frustum Planes from the
// World-View-Projection Matrix"). A matrix that is not finite or has no inverse fails a check, and
// so does one whose frustum has no end (an infinite far plane).
//
// Planes and corners are computed in double, so as floats they are those of the matrix as it is
// given, to 8 epsilon times the largest coordinate of a corner. As doubles they are off by up to
// 32 epsilon times that and far / near: a far plane is a small difference. The matrix itself has
// that difference rounded when it is made, so keep far / near below 1e5 in float.
Frustum frustum_of(const Mat4 &view_projection);

enum class FrustumSide { outside, across, inside };

// Cheap and conservative: `outside` is said only when the whole shape is in front of one plane,
// `inside` when it is behind all six. So a shape near an edge or a corner may be called across that
// is outside; what is called outside or inside is so, but for roundings of 8 epsilon times the
// largest coordinate or size. For a point it is as exact as the planes are.
FrustumSide classify(const Frustum &frustum, const Vec3 &point);
FrustumSide classify(const Frustum &frustum, const Sphere &sphere);
FrustumSide classify(const Frustum &frustum, const Aabb &box);
FrustumSide classify(const Frustum &frustum, const Box &box);
FrustumSide classify(const Frustum &frustum, const Capsule &capsule);

bool contains(const Frustum &frustum, const Vec3 &point);

// A point inside is its own closest point. Near an edge the answer is off by as much as the planes
// are (see frustum_of), over the sine of the angle between the two faces.
Vec3 closest_point(const Frustum &frustum, const Vec3 &point);

// Exact but for roundings of 32 epsilon times the largest coordinate: by the closest point, and by
// separating axes with the frustum's edges (Gottschalk, Lin, Manocha 1996). Where classify gives a
// plain answer, that is taken.
bool overlaps(const Frustum &frustum, const Sphere &sphere);
bool overlaps(const Frustum &frustum, const Aabb &box);
bool overlaps(const Frustum &frustum, const Box &box);

// Where the picture lies in the window, in pixels.
struct Viewport {
    Vec2 origin{Real(0)};
    Vec2 size{Real(1)};
};

// The world point that is drawn at `pixel` with `depth` (0 near, 1 far, as in the depth buffer).
// An empty viewport, a value that is not finite, or a point at infinity fails a check. Roundings
// are magnified by far / near for points far off; far from the origin the inverse is best made as
// inverse view times inverse projection.
Vec3 unproject(const Vec2 &pixel, Real depth, const Mat4 &inverse_view_projection,
               const Viewport &viewport);

// The ray of all points drawn at `pixel`: from the near plane (t = 0) to the far plane
// (t = max_t = 1).
Ray pick_ray(const Vec2 &pixel, const Mat4 &inverse_view_projection, const Viewport &viewport);

} // namespace plumb::inline PLUMB_PRECISION
