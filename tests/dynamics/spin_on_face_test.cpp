// A body spinning on a face slows as under an even pressure over the whole face, whether or not it
// slides at the same time. The reference sums friction over thousands of points of the face.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

constexpr double kilograms = 10;
constexpr double coefficient = 0.3;

// A body lying on a face, and points of that face, in (x, z) of the body, that carry equal loads.
struct Puck {
    const char *name;
    BodyDef body;
    std::vector<glm::dvec2> face;
};

template <typename Within>
std::vector<glm::dvec2> places_of(double half_x, double half_z, Within &&within) {
    constexpr int across = 40;
    std::vector<glm::dvec2> places;
    for (int i = 0; i < across; ++i)
        for (int k = 0; k < across; ++k) {
            const glm::dvec2 place{half_x * ((2 * i + 1.0) / across - 1),
                                   half_z * ((2 * k + 1.0) / across - 1)};
            if (within(place))
                places.push_back(place);
        }
    return places;
}
bool everywhere(const glm::dvec2 & /*place*/) {
    return true;
}

// A prism that stands on a regular polygon.
Puck prism_of(int sides, double radius, double height) {
    std::vector<Vec3> corners;
    const auto way = [&](double corner) {
        const double angle = 2 * pi * corner / sides;
        return glm::dvec2{std::cos(angle), std::sin(angle)};
    };
    for (int i = 0; i < sides; ++i)
        for (const double y : {-height, height})
            corners.push_back(narrow(V{radius * way(i).x, y, radius * way(i).y}));
    const auto within = [&](const glm::dvec2 &at) {
        const double reach = radius * std::cos(pi / sides);
        for (int i = 0; i < sides; ++i)
            if (glm::dot(at, way(i + 0.5)) > reach)
                return false;
        return true;
    };
    const auto mesh = std::make_shared<const HullMesh>(*convex_hull(corners, 64).mesh);
    Puck puck{"prism",
              dynamic_body(ConvexHull{mesh.get(), Vec3{Real(0)}, identity_rotation}, kilograms,
                           V{0, height, 0}),
              places_of(radius, radius, within)};
    puck.body.colliders[0].hull = mesh;
    return puck;
}

std::vector<Puck> pucks_of(double radius) {
    const double height = 0.05 * radius, narrow_side = 0.3 * radius;
    const V place{0, height, 0};
    const auto round = [&](const glm::dvec2 &at) { return glm::length(at) < radius; };
    std::vector<Puck> pucks;
    pucks.push_back({"square", dynamic_body(block(V{radius, height, radius}), kilograms, place),
                     places_of(radius, radius, everywhere)});
    pucks.push_back({"rectangle",
                     dynamic_body(block(V{radius, height, narrow_side}), kilograms, place),
                     places_of(radius, narrow_side, everywhere)});
    pucks.push_back(
        {"disc",
         dynamic_body(Cylinder{narrow(-place), narrow(place), Real(radius)}, kilograms, place),
         places_of(radius, radius, round)});
    for (const int sides : {3, 5, 6, 20})
        pucks.push_back(prism_of(sides, radius, height));
    for (Puck &puck : pucks)
        puck.body = with_material(puck.body, coefficient, 0);
    return pucks;
}

struct Course {
    glm::dvec2 velocity{0}; // along (x, z)
    double spin = 0;        // about y
    double turn = 0;
};

// Coulomb's law at each point, by explicit Euler in short steps.
void rub(Course &course, const Puck &puck, double inertia, double seconds) {
    constexpr int steps = 32;
    const double h = seconds / steps;
    const double each = coefficient * kilograms * gravity / static_cast<double>(puck.face.size());
    for (int step = 0; step < steps; ++step) {
        const double c = std::cos(course.turn), s = std::sin(course.turn);
        glm::dvec2 force{0};
        double torque = 0;
        for (const glm::dvec2 &place : puck.face) {
            const glm::dvec2 at{c * place.x + s * place.y, c * place.y - s * place.x};
            const glm::dvec2 v = course.velocity + course.spin * glm::dvec2{at.y, -at.x};
            const glm::dvec2 rubs = -each / std::max(glm::length(v), 1e-9) * v;
            force += rubs;
            torque += rubs.x * at.y - rubs.y * at.x;
        }
        course.velocity += h / kilograms * force;
        course.spin += h / inertia * torque;
        course.turn += h * course.spin;
    }
}

// The largest errors of speed and spin until the reference stops, relative to the initial values,
// and how much longer the body takes (s).
struct Wrong {
    double speed = 0;
    double spin = 0;
    double longer = 0;
};
Wrong compare(const Puck &puck, double radius, double speed, double spin) {
    StepSettings settings = settings_for("soft_step");
    settings.sleep_after = 0;
    World world("soft_step", settings);
    world.add_body(ground(coefficient, 0));
    BodyDef body = puck.body;
    body.velocity = narrow(V{speed, 0, 0});
    body.angular_velocity = narrow(V{0, spin, 0});
    const BodyId id = world.add_body(body);
    const double inertia = std::max({double(world.model().bodies[id.index].inertia.x),
                                     double(world.model().bodies[id.index].inertia.y),
                                     double(world.model().bodies[id.index].inertia.z)});
    Course course{{speed, 0}, spin, 0};
    const double first = speed + spin * radius;
    Wrong wrong;
    double stops = 0, stopped = 0; // s; 0: not yet
    for (int step = 1; step < 1000 && (stops == 0 || stopped == 0); ++step) {
        rub(course, puck, inertia, settings.dt);
        world.step(nullptr);
        const V v = velocity_of(world, id);
        const double turns = double(motion_of(world, id).angular_velocity.y);
        if (stops == 0) {
            wrong.speed = std::max(wrong.speed,
                                   std::abs(std::hypot(v.x, v.z) - glm::length(course.velocity)));
            wrong.spin = std::max(wrong.spin, std::abs(turns - course.spin));
        }
        if (stops == 0 && glm::length(course.velocity) + course.spin * radius < 0.02 * first)
            stops = step * settings.dt;
        if (stopped == 0 && std::hypot(v.x, v.z) + std::abs(turns) * radius < 0.02 * first)
            stopped = step * settings.dt;
    }
    wrong.speed /= std::max(speed, spin * radius);
    wrong.spin *= radius / std::max(speed, spin * radius);
    wrong.longer = stopped - stops;
    EXPECT_GT(stops, 0);
    EXPECT_GT(stopped, 0);
    return wrong;
}

TEST(SpinOnFace, IsSlowedAsByAnEvenPressure) {
    for (const double radius : {0.05, 0.5})
        for (const Puck &puck : pucks_of(radius))
            for (const double rim_speed : {1.0, 4.0}) {
                SCOPED_TRACE(puck.name);
                const Wrong wrong = compare(puck, radius, 0, rim_speed / radius);
                const double slowing = coefficient * gravity; // m/s^2, about
                EXPECT_LT(wrong.spin, 0.02 + slowing / (60 * rim_speed)) << radius;
                EXPECT_LT(wrong.speed, 0.01) << radius;
                EXPECT_LT(std::abs(wrong.longer), 1.1 / 60 + 0.01 * rim_speed / slowing)
                    << radius << ", " << rim_speed;
            }
}

// Four points stand for the whole face, so this is less exact: while a box spins they brake its
// sliding less than they should.
TEST(SpinOnFace, IsSlowedTheSameWhileItSlides) {
    for (const double radius : {0.05, 0.5})
        for (const Puck &puck : pucks_of(radius))
            for (const double speed : {0.5, 3.0})
                for (const double share : {0.3, 1.0, 3.0}) {
                    SCOPED_TRACE(puck.name);
                    const Wrong wrong = compare(puck, radius, speed, share * speed / radius);
                    EXPECT_LT(wrong.speed, 0.06) << radius << ", " << speed << ", " << share;
                    EXPECT_LT(wrong.spin, 0.11) << radius << ", " << speed << ", " << share;
                    EXPECT_LT(std::abs(wrong.longer), 0.2)
                        << radius << ", " << speed << ", " << share;
                }
}

// A box spins on a slab lying on ice: the angular momentum one loses the other gains, until they
// turn as one.
TEST(SpinOnFace, OfTwoBodiesKeepsAngularMomentum) {
    for (const double spin : {1.0, 10.0, 40.0})
        for (const double aside : {0.0, 0.1}) {
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(0, 0));
            const BodyId below = world.add_body(
                with_material(dynamic_body(block(V{0.5, 0.1, 0.5}), 20, V{0, 0.1, 0}), 0.5, 0));
            BodyDef above =
                with_material(dynamic_body(block(V{0.2, 0.1, 0.1}), 5, V{aside, 0.3, 0}), 0.5, 0);
            above.angular_velocity = narrow(V{0, spin, 0});
            const BodyId upper = world.add_body(above);
            const auto momentum = [&] {
                double sum = 0;
                for (const BodyId id : {below, upper}) {
                    const V at = position_of(world, id), v = velocity_of(world, id);
                    const double m = id == below ? 20 : 5;
                    const double inertia = double(world.model().bodies[id.index].inertia.y);
                    sum += m * (at.z * v.x - at.x * v.z) +
                           inertia * double(motion_of(world, id).angular_velocity.y);
                }
                return sum;
            };
            const double before = momentum();
            run(world, 300);
            EXPECT_NEAR(momentum(), before, 1e-4 * before) << spin << ", " << aside;
            EXPECT_NEAR(double(motion_of(world, below).angular_velocity.y),
                        double(motion_of(world, upper).angular_velocity.y), 1e-3 * spin)
                << spin << ", " << aside;
        }
}

// Contacts are solved side by side: a body that spins elsewhere, too slowly to need more passes,
// changes no bit of the others.
TEST(SpinOnFace, ChangesNothingElsewhere) {
    std::vector<std::vector<Motion>> ends;
    for (const double spin : {0.0, 2.0}) {
        World world("soft_step", settings_for("soft_step"));
        world.add_body(ground(0.3, 0));
        for (int i = 0; i < 6; ++i)
            world.add_body(with_material(
                dynamic_body(block(V{0.3, 0.1, 0.2}), 5, V{2.0 * i, 0.1, 0}, V{0.5 * i, 0, 3}), 0.3,
                0));
        BodyDef far =
            with_material(dynamic_body(block(V{0.3, 0.1, 0.2}), 5, V{0, 0.1, -50}), 0.3, 0);
        far.angular_velocity = narrow(V{0, spin, 0});
        far.velocity = narrow(V{3, 0, 0});
        world.add_body(far);
        run(world, 40);
        ends.emplace_back(world.motions().begin(), world.motions().begin() + 7);
    }
    for (std::size_t i = 1; i < ends[0].size(); ++i) {
        EXPECT_EQ(ends[0][i].position, ends[1][i].position) << i;
        EXPECT_EQ(ends[0][i].velocity, ends[1][i].velocity) << i;
        EXPECT_EQ(ends[0][i].angular_velocity, ends[1][i].angular_velocity) << i;
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
