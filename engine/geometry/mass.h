// Volume and moments of inertia of solid shapes.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"

#include <span>

namespace plumb::inline PLUMB_PRECISION {

Real volume(const Shape &shape); // m^3; infinite for a half-space
Real volume(const Cylinder &cylinder);
Real volume(const ConvexHull &hull);

// Principal moments of inertia (kg m^2) about the centre of mass for a solid of uniform density and
// the given mass (kg), in the shape's principal frame: the local axes for a Box and a Sphere; y
// along the axis for a Capsule and a Cylinder; ascending for a hull. A half-space has none and
// fails a check.
Vec3 principal_inertia(const Shape &shape, Real mass);
Vec3 principal_inertia(const Cylinder &cylinder, Real mass); // y along its axis

// The inertia of a hull of the given mass about its centre of mass (mesh->center), in the mesh's
// own frame.
Mat3 inertia(const ConvexHull &hull, Real mass);

// Principal moments and axes of a symmetric matrix: inertia = R diag(moments) R^T, where R rotates
// from the principal frame. The moments ascend; equal moments have arbitrary axes. A matrix that is
// already diagonal gives coordinate axes.
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

// Of a solid in place, in world space. A half-space fails a check.
MassProperties mass_properties(const Shape &shape);

// Of the solid inside a closed triangle surface, counter-clockwise from outside. The volume is
// negative if the surface is inside out; a surface that encloses no volume gives zeros. Computed in
// double relative to the surface's own middle, so being far from the origin costs no precision.
MassProperties mass_properties(std::span<const Triangle> surface);

} // namespace plumb::inline PLUMB_PRECISION
