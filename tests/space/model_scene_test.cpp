#include "engine/space/model_scene.h"

#include "engine/core/check.h"
#include "tests/geometry/oracle.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;
using Model = ModelScene::Model;

// --- The scene over again, in long double, without a tree and without frames: every triangle in
// the world.

using L = long double;
using W = glm::vec<3, L, glm::defaultp>;

W widest(const Vec3 &v) {
    return {L(v.x), L(v.y), L(v.z)};
}

struct WidePlacement {
    W position{0.0L};
    glm::mat<3, 3, L, glm::defaultp> axes{1.0L};
    L scale = 1.0L;

    W point(const W &local) const { return position + axes * (scale * local); }
};

glm::mat<3, 3, L, glm::defaultp> axes_of(const Quat &rotation) {
    L w = L(rotation.w), x = L(rotation.x), y = L(rotation.y), z = L(rotation.z);
    const L length = std::sqrt(w * w + x * x + y * y + z * z);
    w /= length;
    x /= length;
    y /= length;
    z /= length;
    return {W{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            W{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            W{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

struct Record {
    const MeshTree *mesh = nullptr;
    Placement local;
    Model parent = ModelScene::none;
};

struct WideTriangle {
    W a, b, c;
};

struct Brute {
    std::map<Model, Record> records;
    std::map<Model, std::vector<Model>> children; // `none` holds the roots

    // The models from `model` to its root.
    std::vector<Model> line(Model model) const {
        std::vector<Model> all;
        for (; model != ModelScene::none; model = records.at(model).parent)
            all.push_back(model);
        return all;
    }
    WidePlacement world(Model model) const {
        WidePlacement world;
        const std::vector<Model> all = line(model);
        for (auto up = all.rbegin(); up != all.rend(); ++up) {
            const Placement &local = records.at(*up).local;
            world.position = world.point(widest(local.position));
            world.axes = world.axes * axes_of(local.rotation);
            world.scale *= L(local.scale);
        }
        return world;
    }
    // Cached results, cleared after each change.
    struct Size {
        W position{0.0L};
        L depth = 0, lengths = 0;
    };
    std::map<Model, Size> sizes;
    std::map<Model, std::vector<WideTriangle>> placed;
    const std::vector<WideTriangle> &triangles(Model model) {
        const auto [entry, is_new] = placed.try_emplace(model);
        std::vector<WideTriangle> &all = entry->second;
        const MeshTree *mesh = records.at(model).mesh;
        if (!is_new || mesh == nullptr)
            return all;
        const WidePlacement place = world(model);
        for (std::size_t i = 0; i < mesh->mesh().triangles.size(); ++i) {
            const Triangle t = triangle(mesh->mesh(), i);
            all.push_back(
                {place.point(widest(t.a)), place.point(widest(t.b)), place.point(widest(t.c))});
        }
        return all;
    }
    // How far off the scene may place a model, seen from `from` (see model_scene.h).
    L slack(Model model, const W &from) {
        const auto [entry, is_new] = sizes.try_emplace(model);
        Size &size = entry->second;
        if (is_new) {
            const WidePlacement place = world(model);
            size.position = place.position;
            const std::vector<Model> all = line(model);
            size.depth = L(all.size());
            W last{0.0L};
            for (auto up = all.rbegin(); up != all.rend(); ++up) {
                const W here = world(*up).position;
                size.lengths += glm::length(here - last);
                last = here;
            }
            L extent = 0;
            if (const MeshTree *mesh = records.at(model).mesh)
                for (const Vec3 &v : mesh->mesh().vertices)
                    extent = std::max(extent, place.scale * glm::length(widest(v)));
            size.lengths += extent;
        }
        return 16 * L(std::numeric_limits<Real>::epsilon()) * size.depth *
               (glm::length(size.position - from) + size.lengths);
    }
    bool is_above(Model model, Model other) const { // or equal to it
        const std::vector<Model> all = line(other);
        return std::find(all.begin(), all.end(), model) != all.end();
    }
    void remove(Model model) {
        auto &siblings = children[records.at(model).parent];
        siblings.erase(std::find(siblings.begin(), siblings.end(), model));
        std::vector<Model> gone{model};
        for (std::size_t i = 0; i < gone.size(); ++i) {
            for (const Model child : children[gone[i]])
                gone.push_back(child);
            children.erase(gone[i]);
            records.erase(gone[i]);
        }
    }
    std::vector<Model> models() const {
        std::vector<Model> all;
        for (const auto &[model, record] : records)
            all.push_back(model);
        return all;
    }
};

L distance_to_segment(const W &p, const W &a, const W &b) {
    const W d = b - a;
    const L dd = glm::dot(d, d);
    const L s = dd > 0 ? std::clamp(glm::dot(p - a, d) / dd, 0.0L, 1.0L) : 0.0L;
    return glm::length(p - a - s * d);
}

L distance_to_triangle(const W &p, const WideTriangle &t) {
    const W n = glm::cross(t.b - t.a, t.c - t.a);
    const L nn = glm::dot(n, n);
    if (nn > 0) {
        const W foot = p - n * (glm::dot(p - t.a, n) / nn);
        if (glm::dot(glm::cross(t.b - t.a, foot - t.a), n) >= 0 &&
            glm::dot(glm::cross(t.c - t.b, foot - t.b), n) >= 0 &&
            glm::dot(glm::cross(t.a - t.c, foot - t.c), n) >= 0)
            return glm::length(p - foot);
    }
    return std::min({distance_to_segment(p, t.a, t.b), distance_to_segment(p, t.b, t.c),
                     distance_to_segment(p, t.c, t.a)});
}

// Where a ray's line crosses a triangle's plane, how far inside the nearest edge it passes
// (negative: outside), and how t changes per length that the triangle moves.
struct Passage {
    L t, inside, t_per_length;
};
std::optional<Passage> passage(const WideTriangle &tri, const W &origin, const W &direction) {
    const W n = glm::cross(tri.b - tri.a, tri.c - tri.a);
    const L across = glm::dot(n, direction);
    if (across == 0)
        return std::nullopt;
    Passage result{};
    result.t = glm::dot(n, tri.a - origin) / across;
    result.t_per_length = glm::length(n) / std::abs(across);
    result.inside = std::numeric_limits<L>::infinity();
    const W corners[4] = {tri.a, tri.b, tri.c, tri.a};
    for (int i = 0; i < 3; ++i) {
        const W edge = corners[i + 1] - corners[i];
        const W apart = glm::cross(edge, direction);
        const L side = glm::dot(apart, origin - corners[i]) * (across > 0 ? -1 : 1);
        result.inside = std::min(result.inside, side / glm::length(apart));
    }
    return result;
}

// Whether a triangle touches a box: anything left after clipping to the box's six planes.
bool meets_box(const WideTriangle &t, const Box &box, L grow) {
    const W center = widest(box.center);
    if (distance_to_triangle(center, t) > glm::length(widest(box.half_extents) + W{grow}))
        return false; // most are rejected here
    const auto axes = axes_of(box.rotation);
    std::vector<W> polygon{t.a - center, t.b - center, t.c - center};
    for (int i = 0; i < 3; ++i) {
        const L half = L(box.half_extents[i]) + grow;
        if (half < 0)
            return false;
        for (const L sign : {-1.0L, 1.0L}) {
            std::vector<W> left;
            for (std::size_t k = 0; k < polygon.size(); ++k) {
                const W &here = polygon[k];
                const W &next = polygon[(k + 1) % polygon.size()];
                const L d0 = sign * glm::dot(axes[i], here) - half;
                const L d1 = sign * glm::dot(axes[i], next) - half;
                if (d0 <= 0)
                    left.push_back(here);
                if ((d0 < 0 && d1 > 0) || (d0 > 0 && d1 < 0))
                    left.push_back(here + (next - here) * (d0 / (d0 - d1)));
            }
            polygon = left;
        }
    }
    return !polygon.empty();
}

// --- Meshes and scenes.

TriangleMesh cube() {
    TriangleMesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.vertices.push_back({(k & 1) != 0 ? Real(1) : Real(-1),
                                 (k & 2) != 0 ? Real(1) : Real(-1),
                                 (k & 4) != 0 ? Real(1) : Real(-1)});
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

TriangleMesh soup(Random &random, int count) {
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3 middle = any_vector(random, 1.0);
        const auto first = std::uint32_t(mesh.vertices.size());
        for (int k = 0; k < 3; ++k)
            mesh.vertices.push_back(middle + any_vector(random, 0.5));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

Placement any_placement(Random &random, double reach) {
    Placement placement{any_vector(random, reach), awkward_rotation(random), Real(1)};
    if (random.next_index(2) == 0)
        placement.scale = any_real(random, 0.3, 2.0);
    return placement;
}

class RandomScene {
  public:
    ModelScene scene;
    Brute brute;

    // Between a quarter of `most` and `most` models.
    RandomScene(std::uint64_t seed, double reach, std::size_t most, int soup_size)
        : random_(seed), reach_(reach), most_(most), cube_(cube()), soup_(soup(random_, soup_size)),
          empty_(TriangleMesh{}) {}

    Model any_model() {
        const std::vector<Model> all = brute.models();
        return all[random_.next_index(std::uint32_t(all.size()))];
    }

    void change() {
        brute.placed.clear();
        brute.sizes.clear();
        const std::size_t count = brute.records.size();
        const std::uint32_t action = random_.next_index(10);
        if (count == 0 || count < most_ / 4 || (action < 3 && count < most_)) {
            const std::uint32_t kind = random_.next_index(8);
            Record record{kind == 0   ? nullptr
                          : kind == 1 ? &empty_
                          : kind < 5  ? &cube_
                                      : &soup_,
                          any_placement(random_, reach_), ModelScene::none};
            if (count > 0 && random_.next_index(2) == 0) {
                record.parent = any_model();
                record.local.position /= Real(reach_) / Real(2);
            }
            const Model model = scene.add(record.mesh, record.local, record.parent);
            ASSERT_EQ(brute.records.count(model), 0U);
            brute.records[model] = record;
            brute.children[record.parent].push_back(model);
        } else if (action == 3 && random_.next_index(3) == 0) {
            const Model model = any_model();
            scene.remove(model);
            brute.remove(model);
        } else if (action < 7) {
            const Model model = any_model();
            Record &record = brute.records[model];
            record.local = any_placement(random_, record.parent == ModelScene::none ? reach_ : 2.0);
            scene.set_local(model, record.local);
        } else {
            const Model model = any_model();
            const Model parent = random_.next_index(3) == 0 ? ModelScene::none : any_model();
            if (parent != ModelScene::none && brute.is_above(model, parent)) {
                EXPECT_THROW(scene.set_parent(model, parent), CheckFailure);
                return;
            }
            scene.set_parent(model, parent);
            Record &record = brute.records[model];
            auto &siblings = brute.children[record.parent];
            siblings.erase(std::find(siblings.begin(), siblings.end(), model));
            record.parent = parent;
            brute.children[parent].push_back(model);
        }
    }

    void expect_same_structure() {
        ASSERT_EQ(scene.size(), brute.records.size());
        ASSERT_EQ(scene.roots(), brute.children[ModelScene::none]);
        scene.tree().validate();
        for (const auto &[model, record] : brute.records) {
            ASSERT_TRUE(scene.has(model));
            ASSERT_EQ(scene.parent(model), record.parent);
            ASSERT_EQ(scene.mesh(model), record.mesh);
            ASSERT_EQ(scene.children(model), brute.children[model]);
            const WidePlacement expected = brute.world(model);
            const Placement &world = scene.world(model);
            const L slack = brute.slack(model, expected.position);
            ASSERT_LE(glm::length(widest(world.position) - expected.position), slack);
            ASSERT_NEAR(double(world.scale / expected.scale), 1.0,
                        16 * double(std::numeric_limits<Real>::epsilon()));
            const Aabb box = scene.bounds(model);
            const std::vector<WideTriangle> &triangles = brute.triangles(model);
            ASSERT_EQ(box.min.x > box.max.x, triangles.empty());
            for (const WideTriangle &t : triangles)
                for (const W &corner : {t.a, t.b, t.c})
                    for (int k = 0; k < 3; ++k) {
                        ASSERT_LE(L(box.min[k]), corner[k] + slack);
                        ASSERT_GE(L(box.max[k]), corner[k] - slack);
                    }
        }
    }

    Random &random() { return random_; }

  private:
    Random random_;
    double reach_;
    std::size_t most_;
    MeshTree cube_, soup_, empty_;
};

struct Doubt {
    int asked = 0, doubtful = 0, found = 0;
};

void expect_raycast(RandomScene &s, const Ray &ray, Doubt &doubt) {
    const W origin = widest(ray.origin), direction = widest(ray.direction);
    const L speed = glm::length(direction);
    const std::optional<ModelScene::Hit> hit = s.scene.raycast(ray);
    ASSERT_EQ(s.scene.is_met(ray), hit.has_value());
    doubt.found += hit ? 1 : 0;
    // A returned hit is valid.
    L t_slack = 0;
    if (hit) {
        const L slack = s.brute.slack(hit->model, origin);
        const auto &triangles = s.brute.triangles(hit->model);
        const WideTriangle &t = triangles.at(hit->triangle);
        ASSERT_LE(distance_to_triangle(widest(hit->point), t), slack);
        const auto through = passage(t, origin, direction);
        ASSERT_TRUE(through.has_value());
        ASSERT_GE(through->inside, -slack);
        t_slack = slack * through->t_per_length;
        ASSERT_LE(std::abs(L(hit->t) - through->t), t_slack);
        ASSERT_LE(glm::length(origin + L(hit->t) * direction - widest(hit->point)),
                  t_slack * speed + slack);
        ASSERT_GE(hit->t, Real(0));
        ASSERT_LE(hit->t, ray.max_t);
        const W n = glm::normalize(glm::cross(t.b - t.a, t.c - t.a));
        ASSERT_NEAR(std::abs(double(glm::dot(n, widest(hit->normal)))), 1.0, 1e-4);
        ASSERT_LE(glm::dot(widest(hit->normal), direction), 1e-5 * speed);
    }
    // No certain hit comes before it.
    const L until = hit ? L(hit->t) - t_slack : L(ray.max_t);
    for (const Model model : s.brute.models()) {
        const L slack = s.brute.slack(model, origin);
        const auto &triangles = s.brute.triangles(model);
        for (const WideTriangle &t : triangles) {
            ++doubt.asked;
            const auto through = passage(t, origin, direction);
            if (!through)
                continue;
            const L here = slack * through->t_per_length;
            if (through->inside > slack) {
                ASSERT_FALSE(through->t > here && through->t < until - here)
                    << "model " << model << " was missed";
            } else if (through->inside > -slack) {
                ++doubt.doubtful;
            }
        }
    }
}

template <typename Certain>
void expect_overlapping(RandomScene &s, const std::vector<Model> &found, Doubt &doubt,
                        const W &from, Certain &&certain) {
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
    ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
    for (const Model model : s.brute.models()) {
        const L slack = s.brute.slack(model, from);
        bool may = false, must = false;
        for (const WideTriangle &t : s.brute.triangles(model)) {
            may = may || certain(t, slack);
            must = must || certain(t, -slack);
        }
        const bool got = std::binary_search(found.begin(), found.end(), model);
        ++doubt.asked;
        doubt.doubtful += may != must ? 1 : 0;
        doubt.found += got ? 1 : 0;
        ASSERT_TRUE(!got || may) << "model " << model << " is not there";
        ASSERT_TRUE(got || !must) << "model " << model << " was missed";
    }
}

void expect_few_doubts(const Doubt &doubt, int rounds, int asked_a_round) {
    EXPECT_GE(doubt.asked, rounds * asked_a_round);
    EXPECT_GT(doubt.found, rounds / 10);
    EXPECT_LT(doubt.doubtful, doubt.asked / 100 + 3);
}

// `rounds` of a ray, a sphere and a box, checked against every triangle of every model.
void compare_with_brute_force(RandomScene &s, int rounds, int asked_a_round) {
    Doubt rays, spheres, boxes;
    for (int round = 0; round < rounds; ++round) {
        if (round < 30 || round % 3 == 0)
            s.change();
        if (testing::Test::HasFatalFailure())
            return;
        if (round % 50 == 0)
            s.expect_same_structure();
        if (s.brute.records.empty())
            continue;
        Random &random = s.random();
        const Model about = s.any_model();
        const Vec3 near_by = s.scene.world(about).position;
        Ray ray{near_by + any_vector(random, 6.0), any_vector(random, 1.0)};
        if (random.next_index(2) == 0)
            ray.direction = near_by + any_vector(random, 1.0) - ray.origin;
        if (random.next_index(3) == 0)
            ray.max_t = any_real(random, 0.0, 8.0);
        if (ray.direction == Vec3{Real(0)})
            continue;
        expect_raycast(s, ray, rays);
        const Sphere sphere{near_by + any_vector(random, 3.0), any_real(random, 0.0, 2.0)};
        const W center = widest(sphere.center);
        expect_overlapping(s, s.scene.overlapping(sphere), spheres, center,
                           [&](const WideTriangle &t, L slack) {
                               return distance_to_triangle(center, t) <= L(sphere.radius) + slack;
                           });
        Box box{near_by + any_vector(random, 3.0), awkward_rotation(random),
                glm::abs(any_vector(random, 1.5))};
        expect_overlapping(
            s, s.scene.overlapping(box), boxes, widest(box.center),
            [&](const WideTriangle &t, L slack) { return meets_box(t, box, slack); });
        ASSERT_FALSE(testing::Test::HasFatalFailure()) << "round " << round;
    }
    expect_few_doubts(rays, rounds, asked_a_round);
    expect_few_doubts(spheres, rounds, asked_a_round);
    expect_few_doubts(boxes, rounds, asked_a_round);
}

TEST(ModelScene, AgainstBruteForce) {
    RandomScene scene(1, 6.0, 24, 20);
    compare_with_brute_force(scene, trials(5'000), 5);
}

TEST(ModelScene, AgainstBruteForceFarAway) {
    RandomScene scene(2, 1000.0, 24, 20);
    compare_with_brute_force(scene, trials(5'000), 5);
}

TEST(ModelScene, AMillionOfEachInSmallScenes) {
    RandomScene scene(3, 4.0, 2, 3);
    compare_with_brute_force(scene, trials(1'100'000), 1); // some rounds have no model
}

// Placements without rounding: integer translations, power-of-two scales.
TEST(ModelScene, ExactWhereNothingIsRounded) {
    const MeshTree mesh(cube());
    ModelScene scene;
    const Model group =
        scene.add(nullptr, {{Real(10), Real(0), Real(0)}, identity_rotation, Real(2)});
    const Model child = scene.add(&mesh, {{Real(1), Real(2), Real(3)}}, group);
    // The cube from (10, 2, 4) to (14, 6, 8).
    EXPECT_EQ(scene.world(child).position, (Vec3{Real(12), Real(4), Real(6)}));
    EXPECT_EQ(scene.world(child).scale, Real(2));
    for (const Real y : {Real(2), Real(3), Real(4), Real(6)}) {
        for (const Real z : {Real(4), Real(5), Real(8)}) {
            const auto hit = scene.raycast({{Real(0), y, z}, {Real(2), Real(0), Real(0)}});
            ASSERT_TRUE(hit.has_value()) << y << ' ' << z;
            EXPECT_EQ(hit->model, child);
            EXPECT_EQ(hit->t, Real(5));
            EXPECT_EQ(hit->point, (Vec3{Real(10), y, z}));
        }
        EXPECT_FALSE(scene.raycast({{Real(0), y, Real(9)}, {Real(2), Real(0), Real(0)}}));
        EXPECT_TRUE(scene.is_met({{Real(0), y, Real(5)}, {Real(2), Real(0), Real(0)}, Real(5)}));
        EXPECT_FALSE(
            scene.is_met({{Real(0), y, Real(5)}, {Real(2), Real(0), Real(0)}, Real(4.75)}));
    }
    using Models = std::vector<Model>;
    EXPECT_EQ(scene.overlapping(Sphere{{Real(7), Real(3), Real(5)}, Real(3)}), Models{child});
    EXPECT_EQ(scene.overlapping(Sphere{{Real(6.75), Real(3), Real(5)}, Real(3)}), Models{});
    const Box box{{Real(8), Real(0), Real(5)}, identity_rotation, Vec3{Real(2)}};
    EXPECT_EQ(scene.overlapping(box), Models{child}); // touches along an edge
    Box beside = box;
    beside.center.x = Real(7.75);
    EXPECT_EQ(scene.overlapping(beside), Models{});
    // It has no triangles in its interior.
    EXPECT_EQ(scene.overlapping(Sphere{{Real(12), Real(4), Real(6)}, Real(1)}), Models{});
    // Of two models in the same place the lower number wins.
    const Model twin = scene.add(&mesh, scene.world(child));
    EXPECT_GT(twin, child);
    const auto hit = scene.raycast({{Real(0), Real(3), Real(5)}, {Real(2), Real(0), Real(0)}});
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->model, child);
}

TEST(ModelScene, RemovingTakesWhatIsAttached) {
    const MeshTree mesh(cube());
    ModelScene scene;
    const Model a = scene.add(&mesh, {});
    const Model b = scene.add(&mesh, {{Real(3), Real(0), Real(0)}}, a);
    const Model c = scene.add(&mesh, {{Real(3), Real(0), Real(0)}}, b);
    const Model d = scene.add(&mesh, {{Real(0), Real(0), Real(5)}});
    EXPECT_EQ(scene.world(c).position.x, Real(6));
    scene.set_parent(c, d); // keeps its local placement
    EXPECT_EQ(scene.world(c).position, (Vec3{Real(3), Real(0), Real(5)}));
    scene.remove(a);
    EXPECT_FALSE(scene.has(a));
    EXPECT_FALSE(scene.has(b));
    EXPECT_TRUE(scene.has(c));
    EXPECT_EQ(scene.size(), 2U);
    EXPECT_EQ(scene.tree().size(), 2U);
    EXPECT_EQ(scene.roots(), std::vector<Model>{d});
    EXPECT_FALSE(scene.is_met({{Real(-9), Real(0), Real(0)}, {Real(1), Real(0), Real(0)}}));
}

TEST(ModelScene, RefitFollowsTheMesh) {
    MeshTree mesh(cube());
    ModelScene scene;
    const Model model = scene.add(&mesh, {});
    std::vector<Vec3> moved = mesh.mesh().vertices;
    for (Vec3 &v : moved)
        v.y += Real(100);
    mesh.move_vertices(moved);
    scene.refit(model);
    EXPECT_TRUE(scene.is_met({{Real(-9), Real(100), Real(0)}, {Real(1), Real(0), Real(0)}}));
    EXPECT_FALSE(scene.is_met({{Real(-9), Real(0), Real(0)}, {Real(1), Real(0), Real(0)}}));
}

TEST(ModelScene, PlacementsDoNotDrift) {
    const MeshTree mesh(cube());
    ModelScene moved;
    Random random(5);
    std::vector<Model> models;
    std::vector<Placement> places;
    for (int i = 0; i < 20; ++i) {
        places.push_back(any_placement(random, 3.0));
        models.push_back(moved.add(&mesh, places.back(),
                                   i == 0 ? ModelScene::none : models[std::size_t(i) / 2]));
    }
    const ModelScene fresh = moved;
    for (int i = 0; i < trials(10000); ++i) {
        const std::size_t k = random.next_index(20);
        moved.set_local(models[k], any_placement(random, 3.0));
        moved.set_local(models[k], places[k]);
    }
    for (const Model model : models) {
        EXPECT_EQ(moved.world(model).position, fresh.world(model).position);
        EXPECT_EQ(moved.world(model).rotation, fresh.world(model).rotation);
        EXPECT_EQ(moved.world(model).scale, fresh.world(model).scale);
    }
}

TEST(ModelScene, MisuseNamesTheValueAndChangesNothing) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const MeshTree mesh(cube());
    ModelScene scene;
    says([&] { scene.add(&mesh, {{nan, Real(0), Real(0)}}); }, "nan");
    says([&] { scene.add(&mesh, {Vec3{Real(0)}, identity_rotation, Real(-2)}); }, "-2");
    says(
        [&] {
            scene.add(&mesh, {Vec3{Real(0)}, Quat{Real(3), Real(0), Real(0), Real(0)}});
        },
        "unit length");
    says([&] { scene.add(&mesh, {}, 7); }, "7");
    EXPECT_EQ(scene.size(), 0U);
    const Model a = scene.add(&mesh, {});
    const Model b = scene.add(&mesh, {Vec3{Real(1)}, identity_rotation, Real(1000)}, a);
    const Model c = scene.add(&mesh, {Vec3{Real(1)}, identity_rotation, Real(1000)}, b);
    says([&] { scene.set_parent(a, c); }, "itself or attached");
    says([&] { scene.set_parent(a, a); }, "itself or attached");
    says([&] { scene.set_parent(a, 99); }, "99");
    // c's world scale would be 1e9.
    says([&] { scene.set_local(a, {Vec3{Real(1)}, identity_rotation, Real(1000)}); }, "scale");
    EXPECT_EQ(scene.world(a).position, Vec3{Real(0)});
    EXPECT_EQ(scene.world(c).scale, Real(1e6));
    says([&] { scene.add(&mesh, {Vec3{Real(0)}, identity_rotation, Real(10)}, c); }, "scale");
    EXPECT_EQ(scene.size(), 3U);
    EXPECT_EQ(scene.children(c), std::vector<Model>{});
    says([&] { (void)scene.raycast({Vec3{nan}, Vec3{Real(1)}}); }, "nan");
    says([&] { (void)scene.overlapping(Sphere{Vec3{Real(0)}, Real(-1)}); }, "-1");
    says([&] { (void)scene.overlapping(Box{Vec3{nan}}); }, "nan");
    says([&] { scene.remove(44); }, "44");
    scene.remove(a);
    says([&] { (void)scene.world(b); }, "not a model");
    says([&] { scene.remove(a); }, "not a model");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
