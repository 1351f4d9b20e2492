// Volume and moments of inertia of solid shapes.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"

#include <span>

namespace plumb::inline PLUMB_PRECISION {

Real volume(const Shape &shape); // m^3; infinite for a half-space
Real volume(const Cylinder &cylinder);
Real volume(const ConvexHull &hull);

// Principal moments of inertia (kg m^2) about the centre of mass for a solid of that mass (kg) and
// uniform density, in the shape's own principal frame: the local axes for a Box and a Sphere; for a
// Capsule and a Cylinder y is along the axis; those of a hull ascend. A half-space has none: fails
// a check.
Vec3 principal_inertia(const Shape &shape, Real mass);
Vec3 principal_inertia(const Cylinder &cylinder, Real mass); // y along its axis

// The inertia of a hull of that mass about its centre of mass (mesh->center), on the axes of its
// own frame.
Mat3 inertia(const ConvexHull &hull, Real mass);

// Principal moments and the axes they belong to: inertia = R diag(moments) R^T, with R the rotation
// from the principal frame. For a symmetric matrix; the moments ascend, and the axes of equal ones
// are any. An inertia that is diagonal already gives axes that are axes.
struct PrincipalFrame {
    Vec3 moments{Real(0)};
    Quat rotation = identity_rotation;
};
PrincipalFrame principal_frame(const Mat3 &inertia);

struct MassProperties {
    Real volume = Real(0); // m^3
    Vec3 center{Real(0)};
    Mat3 inertia{Real(0)}; // about the centre, for a density of 1 kg/m^3
};

// Of a solid where it is. A half-space fails a check.
MassProperties mass_properties(const Shape &shape);

// Of the solid within a closed surface of triangles, counter-clockwise from outside. Inside out the
// volume is negative; a surface around no volume gives zeros. Computed in double; from the
// surface's own middle, so a place far away costs no digits.
MassProperties mass_properties(std::span<const Triangle> surface);

} // namespace plumb::inline PLUMB_PRECISION
