// Cylinders and prisms on slopes: they stand as long as the vertical through their centre of mass
// meets the base, and fall beyond that.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

enum class Support { plane, block, mesh, field };

// An upright column: a cylinder if it has no sides, else a prism.
struct Column {
    int sides = 0;
    double height = 0;
    double radius = 0; // to the corners
    double yaw = 0;
    double downhill = 0; // angle about the vertical

    // From the axis to the outline, downhill.
    double reach() const {
        double least = sides == 0 ? radius : std::numeric_limits<double>::infinity();
        for (int i = 0; i < sides; ++i) {
            const double off = (2 * i + 1) * pi / sides - yaw - downhill;
            if (std::cos(off) > 1e-9)
                least = std::min(least, radius * std::cos(pi / sides) / std::cos(off));
        }
        return least;
    }
};

BodyDef body_of(const Column &column) {
    const double half = column.height / 2;
    BodyDef def =
        dynamic_body(Cylinder{narrow(V{0, -half, 0}), narrow(V{0, half, 0}), Real(column.radius)},
                     1, {0, half, 0});
    if (column.sides > 0) {
        std::vector<Vec3> corners;
        for (int i = 0; i < column.sides; ++i)
            for (const double y : {-half, half}) {
                const double angle = 2 * i * pi / column.sides;
                corners.push_back(
                    narrow(V{column.radius * std::cos(angle), y, column.radius * std::sin(angle)}));
            }
        const auto mesh = std::make_shared<const HullMesh>(*convex_hull(corners, 128).mesh);
        def.colliders[0].shape = ConvexHull{mesh.get(), Vec3{Real(0)}, identity_rotation};
        def.colliders[0].hull = mesh;
    }
    def.pose.rotation = narrow(glm::angleAxis(column.yaw, V{0, 1, 0}));
    return with_material(def, 5, 0);
}

// Six by six cells.
std::shared_ptr<const TriangleSurface> level_surface(bool as_field, double cell) {
    constexpr int n = 6;
    const auto at = [&](int i) { return (i - 0.4 * n) * cell; };
    if (as_field) {
        HeightField field;
        field.rows = field.columns = n + 1;
        field.spacing = Real(cell);
        field.origin = narrow(V{at(0), 0, at(0)});
        field.heights.assign(std::size_t((n + 1) * (n + 1)), Real(0));
        return std::make_shared<const TriangleSurface>(field, Sides::front);
    }
    TriangleMesh mesh;
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= n; ++column)
            mesh.vertices.push_back(narrow(V{at(column), 0, at(row)}));
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const auto corner = std::uint32_t(row * (n + 1) + column);
            const std::uint32_t next = corner + n + 1;
            mesh.triangles.push_back({corner, next, next + 1});
            mesh.triangles.push_back({corner, next + 1, corner + 1});
        }
    return std::make_shared<const TriangleSurface>(mesh, Sides::front);
}

BodyDef support_of(Support support, const Column &column) {
    const double width = 2 * column.radius;
    if (support == Support::plane)
        return ground(5, 0);
    if (support == Support::block)
        return with_material(static_body(block({3 * width, width, 3 * width}), {0, -width, 0}), 5,
                             0);
    BodyDef def;
    def.kind = BodyKind::static_body;
    const bool as_field = support == Support::field;
    def.colliders.emplace_back().surface = level_surface(as_field, (as_field ? 0.7 : 3) * width);
    return with_material(def, 5, 0);
}

enum class Fate { falls, stands, sleeps };

Fate fate_of(World &world, BodyId id, double seconds) {
    constexpr int between = 8; // steps from look to look
    for (int step = 0; step < seconds / world.settings().dt; step += between) {
        run(world, between);
        const V up = wide(world.pose_of(id.index).rotation) * V{0, 1, 0};
        if (up.y < std::cos(0.15))
            return Fate::falls;
        if (all_sleep(world))
            return Fate::sleeps;
    }
    return Fate::stands;
}

// `share`: of the tangent of the slope at which it should fall.
Fate fate_on_slope(const Column &column, Support support, double share, double rate) {
    const double slope = std::atan(share * column.reach() / (column.height / 2));
    const V downhill{std::cos(column.downhill), 0, std::sin(column.downhill)};
    StepSettings settings = settings_for("soft_step");
    settings.dt = 1 / rate;
    settings.gravity = gravity * (std::sin(slope) * downhill - V{0, std::cos(slope), 0});
    World world("soft_step", settings);
    world.add_body(support_of(support, column));
    const BodyId id = world.add_body(body_of(column));
    return fate_of(world, id, 5);
}

Column any_column(Random &random, int sides) {
    Column column;
    column.sides = sides;
    column.height = 0.02 * std::pow(100, random.next_in(0, 1));
    column.radius = 0.5 * column.height / (0.5 * std::pow(10, random.next_in(0, 1)));
    column.yaw = random.next_in(0, 2 * pi);
    column.downhill = random.next_in(0, 2 * pi);
    return column;
}

constexpr std::array<int, 5> sides_of_columns = {0, 8, 12, 16, 24};

template <typename Check> void with_columns(int count, Check &&check) {
    Random random(11);
    for (const int sides : sides_of_columns)
        for (int i = 0; i < count; ++i) {
            const Column column = any_column(random, sides);
            SCOPED_TRACE(std::to_string(sides) + " sides, " + std::to_string(column.height) +
                         " m high, radius " + std::to_string(column.radius) + " m, yaw " +
                         std::to_string(column.yaw) + ", downhill " +
                         std::to_string(column.downhill));
            check(column);
        }
}

TEST(Tipping, ColumnsStandOnSlopesAsLongAsTheyShould) {
    for (const Support support : {Support::plane, Support::block})
        for (const double rate : {60.0, 240.0})
            with_columns(rate > 100 ? 2 : 6, [&](const Column &column) {
                EXPECT_NE(fate_on_slope(column, support, 0.94, rate), Fate::falls);
                EXPECT_EQ(fate_on_slope(column, support, 1.02, rate), Fate::falls);
            });
}

TEST(Tipping, ColumnsStandOnSlopingMeshes) {
    for (const Support support : {Support::mesh, Support::field})
        with_columns(3, [&](const Column &column) {
            EXPECT_NE(fate_on_slope(column, support, 0.93, 60), Fate::falls);
            EXPECT_EQ(fate_on_slope(column, support, 1.02, 60), Fate::falls);
        });
}

TEST(Tipping, ColumnsThatStandFallAsleep) {
    with_columns(4, [&](const Column &column) {
        EXPECT_EQ(fate_on_slope(column, Support::plane, 0.8, 60), Fate::sleeps);
    });
}

// With the centre of mass this far from the edge, as a share of the reach.
TEST(Tipping, ColumnsStandAtTheEdgeOfATable) {
    with_columns(4, [&](Column column) {
        column.downhill = 0;
        for (const double beyond : {-0.03, 0.02}) {
            World world("soft_step", settings_for("soft_step"));
            const double width = 2 * column.radius;
            world.add_body(with_material(
                static_body(block({5 * width, width, 5 * width}), {-5 * width, -width, 0}), 5, 0));
            BodyDef def = body_of(column);
            def.pose.position.x = Real(beyond * column.reach());
            const BodyId id = world.add_body(def);
            EXPECT_EQ(fate_of(world, id, 5) == Fate::falls, beyond > 0);
        }
    });
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
