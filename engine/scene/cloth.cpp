#include "engine/scene/cloth.h"

#include "engine/core/check.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

using Kind = ClothSpring::Kind;

// Builds a cloth, with its springs keyed by their ends.
class Weaver {
  public:
    explicit Weaver(std::vector<glm::dvec3> places) { parts_.places = std::move(places); }

    // The spring between two particles, created on first use.
    std::uint32_t spring(Kind kind, std::uint32_t a, std::uint32_t b) {
        const std::pair<std::uint32_t, std::uint32_t> ends = std::minmax(a, b);
        const auto [entry, is_new] =
            springs_.try_emplace(ends, static_cast<std::uint32_t>(parts_.springs.size()));
        if (is_new)
            parts_.springs.push_back({kind, ends.first, ends.second, length(a, b)});
        return entry->second;
    }
    double length(std::uint32_t a, std::uint32_t b) const {
        return glm::distance(parts_.places[a], parts_.places[b]);
    }
    void triangle(Kind side, const std::array<std::uint32_t, 3> &corners) {
        ClothTriangle made{corners, {}};
        for (std::size_t i = 0; i < 3; ++i)
            made.sides[i] = spring(side, corners[i], corners[(i + 1) % 3]);
        parts_.triangles.push_back(made);
    }
    ClothParts take() { return std::move(parts_); }

  private:
    ClothParts parts_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> springs_;
};

ClothParts woven_grid(const ClothDesc &cloth) {
    const int nx = cloth.cells[0];
    const int nz = cloth.cells[1];
    PLUMB_CHECK(nx >= 1 && nz >= 1, "a cloth of " << nx << " x " << nz << " cells");
    std::vector<glm::dvec3> places(particle_count(cloth));
    for (std::uint32_t i = 0; i < places.size(); ++i)
        places[i] = cloth_place(cloth, i);
    Weaver weaver(std::move(places));
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (nx + 1) + i); };
    const auto along = [&](Kind kind, int di, int dj) {
        for (int j = 0; j + dj <= nz; ++j)
            for (int i = 0; i + di <= nx; ++i)
                weaver.spring(kind, at(i, j), at(i + di, j + dj));
    };
    along(Kind::stretch, 1, 0);
    along(Kind::stretch, 0, 1);
    for (int j = 0; j < nz; ++j)
        for (int i = 0; i < nx; ++i) {
            weaver.spring(Kind::shear, at(i, j), at(i + 1, j + 1));
            weaver.spring(Kind::shear, at(i + 1, j), at(i, j + 1));
        }
    along(Kind::bend, 2, 0);
    along(Kind::bend, 0, 2);
    // All sides are already springs, so the kind does not matter.
    for (int j = 0; j < nz; ++j)
        for (int i = 0; i < nx; ++i) {
            const std::array corners{at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)};
            const std::size_t first = (i + j) % 2 == 0 ? 0 : 1;
            const auto corner = [&](std::size_t k) { return corners[(first + k) % 4]; };
            weaver.triangle(Kind::shear, {corner(0), corner(1), corner(2)});
            weaver.triangle(Kind::shear, {corner(2), corner(3), corner(0)});
        }
    return weaver.take();
}

ClothParts woven_mesh(const MeshData &mesh) {
    Weaver weaver(mesh.vertices);
    for (const std::array<std::uint32_t, 3> &corners : mesh.triangles)
        weaver.triangle(Kind::stretch, corners);
    // The corners opposite each edge.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> opposite;
    for (const std::array<std::uint32_t, 3> &corners : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i)
            opposite[std::minmax(corners[i], corners[(i + 1) % 3])].push_back(corners[(i + 2) % 3]);
    for (const auto &[edge, corners] : opposite)
        if (corners.size() == 2 && weaver.length(corners[0], corners[1]) > 0)
            weaver.spring(Kind::bend, corners[0], corners[1]);
    return weaver.take();
}

} // namespace

std::size_t particle_count(const ClothDesc &cloth) {
    return cloth.mesh ? cloth.mesh->vertices.size()
                      : static_cast<std::size_t>(cloth.cells[0] + 1) *
                            static_cast<std::size_t>(cloth.cells[1] + 1);
}

ClothParts cloth_parts(const ClothDesc &cloth) {
    return cloth.mesh ? woven_mesh(*cloth.mesh) : woven_grid(cloth);
}

glm::dvec3 cloth_place(const ClothDesc &cloth, std::uint32_t particle) {
    if (cloth.mesh)
        return cloth.mesh->vertices.at(particle);
    // Measured from the middle, so that the grid is exactly symmetric.
    const auto place = [](double size, int i, int count) {
        return size * (2 * i - count) / (2 * count);
    };
    const int columns = cloth.cells[0] + 1;
    const int at = static_cast<int>(particle);
    return {place(cloth.size.x, at % columns, cloth.cells[0]), 0,
            place(cloth.size.y, at / columns, cloth.cells[1])};
}

ParticleState start_of(const ClothDesc &cloth, std::uint32_t particle) {
    if (particle < cloth.particles.size())
        return cloth.particles[particle];
    return {cloth.position + cloth.orientation * cloth_place(cloth, particle), glm::dvec3(0)};
}

std::string particle_name(const ClothDesc &cloth, std::uint32_t particle) {
    const auto columns = static_cast<std::uint32_t>(cloth.cells[0] + 1);
    const std::string index =
        cloth.mesh ? std::to_string(particle)
                   : std::to_string(particle % columns) + "," + std::to_string(particle / columns);
    return cloth.name + "[" + index + "]";
}

std::optional<std::uint32_t> find_particle(const ClothDesc &cloth, std::string_view brackets) {
    if (!brackets.starts_with('[') || !brackets.ends_with(']'))
        return std::nullopt;
    const char *at = brackets.data() + 1;
    const char *end = brackets.data() + brackets.size() - 1;
    const auto take = [&](std::size_t count) -> std::optional<std::uint32_t> {
        while (at != end && *at == ' ')
            ++at;
        std::uint32_t index = 0;
        const auto read = std::from_chars(at, end, index);
        at = read.ptr;
        return read.ec == std::errc() && index < count ? std::optional(index) : std::nullopt;
    };
    if (cloth.mesh) {
        const std::optional<std::uint32_t> vertex = take(cloth.mesh->vertices.size());
        return at == end ? vertex : std::nullopt;
    }
    const auto columns = static_cast<std::uint32_t>(cloth.cells[0] + 1);
    const std::optional<std::uint32_t> i = take(columns);
    if (!i || at == end || *at++ != ',')
        return std::nullopt;
    const std::optional<std::uint32_t> j = take(static_cast<std::size_t>(cloth.cells[1]) + 1);
    return j && at == end ? std::optional(*j * columns + *i) : std::nullopt;
}

double stiffness_of(const ClothDesc &cloth, ClothSpring::Kind kind) {
    switch (kind) {
    case Kind::stretch:
        return cloth.stretch;
    case Kind::shear:
        return cloth.shear;
    case Kind::bend:
        return cloth.bend;
    }
    return 0;
}

} // namespace plumb
