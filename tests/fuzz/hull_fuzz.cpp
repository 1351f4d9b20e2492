// libFuzzer target: the hull of any points is convex and closed, or the reason why not is given.
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/quickhull.h"
#include "tests/fuzz/input.h"

#include <vector>

#include <glm/geometric.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using namespace plumb;
    FuzzInput input(data, size);
    const int most = 4 + static_cast<int>(input.below(60));
    std::vector<Vec3> points;
    while (!input.is_empty() && points.size() < 200)
        points.push_back(input.point());
    const HullResult result = convex_hull(points, most);
    FUZZ_ASSERT(result.mesh.has_value() == (result.problem == HullProblem::none));
    if (!result.mesh)
        return 0;
    const HullMesh &mesh = *result.mesh;
    FUZZ_ASSERT(mesh.vertices.size() <= static_cast<std::size_t>(most));
    // Euler's formula, each edge once, and no vertex in front of a face by more than rounding.
    FUZZ_ASSERT(mesh.vertices.size() + mesh.faces.size() == mesh.edges.size() + 2);
    FUZZ_ASSERT(mesh.volume > Real(0));
    Real reach = Real(0);
    for (const Vec3 &vertex : mesh.vertices)
        for (int i = 0; i < 3; ++i)
            reach = std::max(reach, std::abs(vertex[i]));
    const Real rounding =
        result.tolerance + Real(16) * std::numeric_limits<Real>::epsilon() * reach;
    for (const Plane &plane : mesh.planes)
        for (const Vec3 &vertex : mesh.vertices)
            FUZZ_ASSERT(glm::dot(plane.normal, vertex) - plane.offset <= rounding);
    // Queries succeed, and their answers agree.
    const ConvexHull hull{&mesh, Vec3{Real(0)}, identity_rotation};
    FUZZ_ASSERT(contains(hull, mesh.vertices.front()));
    const Vec3 p = input.point();
    const Vec3 closest = closest_point(hull, p);
    FUZZ_ASSERT(!contains(hull, p) || closest == p);
    return 0;
}
