// Rays against triangle meshes, one ray at a time, against Embree 3 in robust mode.
#include "engine/space/mesh_tree.h"
#include "tests/bench/contest.h"
#include "tests/bench/inputs.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <embree3/rtcore.h>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

// A torus of rings by sides quads, dented so that no two triangles are alike.
TriangleMesh dented_torus(std::uint32_t rings, std::uint32_t sides) {
    TriangleMesh mesh;
    const double turn = 2 * std::numbers::pi;
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < sides; ++j) {
            const double u = turn * i / rings, v = turn * j / sides;
            const double r = 0.4 + 0.05 * std::sin(9 * u) * std::cos(5 * v);
            const double ring = 1 + r * std::cos(v);
            mesh.vertices.emplace_back(static_cast<float>(ring * std::cos(u)),
                                       static_cast<float>(r * std::sin(v)),
                                       static_cast<float>(ring * std::sin(u)));
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
        return (i % rings) * sides + j % sides;
    };
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < sides; ++j) {
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    return mesh;
}

class EmbreeMesh {
  public:
    explicit EmbreeMesh(const TriangleMesh &mesh) : device_(rtcNewDevice("threads=1")) {
        if (device_ == nullptr)
            throw std::runtime_error("Embree gives no device");
        scene_ = rtcNewScene(device_);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto *vertices = static_cast<Vec3 *>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Vec3), mesh.vertices.size()));
        std::copy(mesh.vertices.begin(), mesh.vertices.end(), vertices);
        using Index = std::array<std::uint32_t, 3>;
        auto *indices = static_cast<Index *>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(Index), mesh.triangles.size()));
        std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~EmbreeMesh() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    EmbreeMesh(const EmbreeMesh &) = delete;
    EmbreeMesh &operator=(const EmbreeMesh &) = delete;

    bool meets(const Ray &ray, RTCIntersectContext &context) const {
        RTCRayHit query{};
        query.ray.org_x = ray.origin.x;
        query.ray.org_y = ray.origin.y;
        query.ray.org_z = ray.origin.z;
        query.ray.dir_x = ray.direction.x;
        query.ray.dir_y = ray.direction.y;
        query.ray.dir_z = ray.direction.z;
        query.ray.tfar = ray.max_t;
        query.ray.mask = ~0U;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_, &context, &query);
        return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }

  private:
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

constexpr std::size_t ray_count = 1 << 14;

// Primary rays through the pixels of an image, row by row.
std::vector<Ray> coherent_rays() {
    std::vector<Ray> rays;
    const Vec3 eye{0.6f, 2.2f, 2.4f};
    const Vec3 forward = glm::normalize(-eye);
    const Vec3 right = glm::normalize(glm::cross(forward, Vec3{0, 1, 0}));
    const Vec3 up = glm::cross(right, forward);
    constexpr int side = 128;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto u = (static_cast<float>(x) + 0.5f) / side - 0.5f;
            const auto v = 0.5f - (static_cast<float>(y) + 0.5f) / side;
            rays.push_back({eye, forward + 0.9f * (u * right + v * up)});
        }
    return rays;
}

std::vector<Ray> random_rays() {
    std::vector<Ray> rays;
    Random random(31);
    while (rays.size() < ray_count) {
        const Vec3 origin = inputs::vector(random, 2);
        const Vec3 direction = inputs::vector(random, 1);
        if (direction != Vec3{0})
            rays.push_back({origin, direction});
    }
    return rays;
}

} // namespace

std::vector<Contest> mesh_contests(std::size_t largest) {
    std::vector<Contest> contests;
    for (const std::uint32_t rings : {100U, 316U, 1000U}) {
        const std::uint32_t sides = rings / 2;
        const std::size_t triangles = 2UL * rings * sides;
        if (triangles > largest)
            break;
        const TriangleMesh mesh = dented_torus(rings, sides);
        const auto tree = std::make_shared<const MeshTree>(mesh);
        const auto embree = std::make_shared<const EmbreeMesh>(mesh);
        for (const bool coherent : {true, false}) {
            const auto rays = std::make_shared<const std::vector<Ray>>(coherent ? coherent_rays()
                                                                                : random_rays());
            contests.push_back({std::string(coherent ? "coherent" : "random") + " rays, mesh of " +
                                    std::to_string(triangles),
                                rays->size(),
                                {"raycast",
                                 [tree, rays] {
                                     std::uint64_t yes = 0;
                                     for (const Ray &ray : *rays)
                                         yes += raycast(*tree, ray).has_value() ? 1 : 0;
                                     return yes;
                                 }},
                                {{"Embree robust",
                                  [embree, rays] {
                                      RTCIntersectContext context;
                                      rtcInitIntersectContext(&context);
                                      std::uint64_t yes = 0;
                                      for (const Ray &ray : *rays)
                                          yes += embree->meets(ray, context) ? 1 : 0;
                                      return yes;
                                  }}},
                                0.8});
        }
    }
    return contests;
}

} // namespace plumb
