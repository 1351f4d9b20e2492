// Particles against bodies of every shape.
#include "engine/geometry/quickhull.h"
#include "tests/dynamics/avbd_passes.h"
#include "tests/dynamics/particles.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class ParticleContacts : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, ParticleContacts, testing::ValuesIn(particle_contact_methods()),
                         name_of);

constexpr double particle_radius = 0.05;
constexpr double particle_mass = 0.1;

ParticleDef grain_at(const V &position, const V &velocity = V{0}) {
    ParticleDef def = moving_particle(position, velocity, particle_mass);
    def.radius = Real(particle_radius);
    return def;
}

// A flat 4 m square of 8 x 8 cells.
BodyDef flat_body(bool as_field) {
    constexpr int n = 8;
    constexpr double cell = 0.5;
    BodyDef def;
    def.kind = BodyKind::static_body;
    std::shared_ptr<const TriangleSurface> &surface = def.colliders.emplace_back().surface;
    if (as_field) {
        HeightField field;
        field.rows = field.columns = n + 1;
        field.spacing = Real(cell);
        field.origin = narrow(V{-0.5 * n * cell, 0, -0.5 * n * cell});
        field.heights.assign((n + 1) * (n + 1), Real(0));
        surface = std::make_shared<const TriangleSurface>(field, Sides::both);
        return def;
    }
    TriangleMesh mesh;
    for (int row = 0; row <= n; ++row)
        for (int column = 0; column <= n; ++column)
            mesh.vertices.push_back(
                narrow(V{(column - 0.5 * n) * cell, 0, (row - 0.5 * n) * cell}));
    for (std::uint32_t row = 0; row < n; ++row)
        for (std::uint32_t column = 0; column < n; ++column) {
            const std::uint32_t at = row * (n + 1) + column;
            mesh.triangles.push_back({at, at + n + 1, at + n + 2});
            mesh.triangles.push_back({at, at + n + 2, at + 1});
        }
    surface = std::make_shared<const TriangleSurface>(mesh, Sides::both);
    return def;
}

struct Stand {
    std::string name;
    BodyDef body; // fixed
    double top;   // m, at x = z = 0
};

std::vector<Stand> stands() {
    std::vector<Stand> all;
    all.push_back({"sphere", static_body(ball(0.4)), 0.4});
    all.push_back({"box", static_body(block(V{0.5, 0.2, 0.5})), 0.2});
    all.push_back({"capsule",
                   static_body(Capsule{narrow(V{-0.5, 0, 0}), narrow(V{0.5, 0, 0}), Real(0.3)}),
                   0.3});
    all.push_back({"cylinder",
                   static_body(Cylinder{narrow(V{0, -0.3, 0}), narrow(V{0, 0.3, 0}), Real(0.5)}),
                   0.3});
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(narrow(V{i & 1 ? 0.5 : -0.5, i & 2 ? 0.25 : -0.25, i & 4 ? 0.4 : -0.4}));
    const auto mesh = std::make_shared<const HullMesh>(*convex_hull(corners, 64).mesh);
    BodyDef hull = static_body(ConvexHull{mesh.get(), Vec3{Real(0)}, identity_rotation});
    hull.colliders[0].hull = mesh;
    all.push_back({"hull", hull, 0.25});
    BodyDef compound = static_body(block(V{0.6, 0.1, 0.6}));
    compound.colliders.emplace_back().shape =
        Box{narrow(V{0, 0.2, 0}), identity_rotation, narrow(V{0.2, 0.1, 0.2})};
    all.push_back({"compound", compound, 0.3});
    all.push_back({"half-space", ground(0.5, 0), 0});
    all.push_back({"mesh", flat_body(false), 0});
    all.push_back({"height field", flat_body(true), 0});
    return all;
}

// Dropped from 30 cm, a particle comes to rest on the surface.
TEST_P(ParticleContacts, ComeToRestOnEveryShape) {
    for (const Stand &stand : stands()) {
        World world(GetParam(), settings_for(GetParam()));
        world.add_body(stand.body);
        world.add_particle(grain_at(V{0, stand.top + particle_radius + 0.3, 0}));
        run(world, 120);
        EXPECT_NEAR(particle_position(world, 0).y, stand.top + particle_radius, 2e-4) << stand.name;
        EXPECT_LT(glm::length(particle_velocity(world, 0)), 1e-5) << stand.name;
    }
}

// Inside solid ground they come up and rest on it; below a one-sided one they fall.
TEST_P(ParticleContacts, ComeOutOfSolidGround) {
    HeightField level;
    level.rows = level.columns = 9;
    level.spacing = Real(0.5);
    level.origin = narrow(V{-2, 0, -2});
    level.heights.assign(81, Real(0));
    for (const Sides sides : {Sides::front, Sides::solid}) {
        World world(GetParam(), settings_for(GetParam()));
        BodyDef def;
        def.kind = BodyKind::static_body;
        def.colliders.emplace_back().surface =
            std::make_shared<const TriangleSurface>(level, sides);
        world.add_body(with_material(def, 0.5, 0));
        world.add_particle(grain_at(V{0.1, -0.2, 0.15}));
        run(world, 240);
        if (sides == Sides::front)
            EXPECT_LT(particle_position(world, 0).y, -10);
        else
            EXPECT_NEAR(particle_position(world, 0).y, particle_radius, 2e-4);
    }
}

// At 100 m/s, 1.7 m a step, against 1 cm walls: head-on and at an angle, boxes and triangles, and
// walls moving the other way.
TEST_P(ParticleContacts, FastOnesDoNotPassAThinWall) {
    Random random(3);
    for (int trial = 0; trial < 60; ++trial) {
        World world(GetParam(), weightless(settings_for(GetParam())));
        const bool moves = trial % 3 == 2;
        BodyDef wall = trial % 3 == 0 ? flat_body(false) : static_body(block(V{2, 0.005, 2}));
        if (moves) {
            wall.kind = BodyKind::kinematic;
            wall.velocity = narrow(V{0, 50, 0});
        }
        world.add_body(wall);
        const double away = random.next_in(0.1, 3);
        V velocity{random.next_in(-20, 20), -100, random.next_in(-20, 20)};
        if (moves)
            velocity.y = -50;
        const double time = away / 100;
        world.add_particle(grain_at(V{-velocity.x * time, away, -velocity.z * time}, velocity));
        run(world, 6);
        const double wall_at = position_of(world, world.body_id(0)).y;
        EXPECT_GT(particle_position(world, 0).y, wall_at) << trial;
    }
}

// A particle that passes a ball 1 cm away is not deflected.
TEST_P(ParticleContacts, FastOnesPassWhatTheyMiss) {
    World world(GetParam(), weightless(settings_for(GetParam())));
    world.add_body(static_body(ball(0.3)));
    world.add_particle(grain_at(V{-2, 0.36, 0}, V{60, 0, 0}));
    run(world, 6);
    EXPECT_NEAR(particle_velocity(world, 0).x, 60, 1e-4);
    EXPECT_NEAR(particle_position(world, 0).y, 0.36, 1e-5);
}

// Below the friction angle a particle stays put to the micrometre; above it, it slides
// x = (sin - mu cos) g t^2 / 2.
TEST_P(ParticleContacts, FrictionHoldsAndSlidesOnASlope) {
    constexpr double mu = 0.5;
    for (const double angle : {0.4, 0.6}) { // the limit is atan(0.5) = 0.4636
        const V normal{std::sin(angle), std::cos(angle), 0};
        World world(GetParam(), settings_for(GetParam()));
        world.add_body(ground(mu, 0, normal));
        ParticleDef def = grain_at(particle_radius * normal);
        def.material.friction = Real(mu);
        world.add_particle(def);
        run(world, 60);
        const V down{std::cos(angle), -std::sin(angle), 0};
        const double way = glm::dot(particle_position(world, 0) - particle_radius * normal, down);
        // Known failing: AVBD's particle contacts start from scratch in each substep, and slip by
        // what its passes leave of gravity's motion.
        const double left = GetParam() == "avbd" ? left_by_avbd(world) * gravity : 0;
        const double h = substep_of(world);
        if (angle < std::atan(mu)) {
            if (left > 0) {
                EXPECT_NEAR(way, 0.5 * left * std::sin(angle) * h,
                            0.5 * left * std::sin(angle) * h);
                continue;
            }
            run(world, 600);
            EXPECT_NEAR(glm::dot(particle_position(world, 0), down), way, 1e-6);
            EXPECT_NEAR(way, 0, 1e-5);
            continue;
        }
        const double a = gravity * (std::sin(angle) - mu * std::cos(angle));
        // Semi-implicit Euler is a h t / 2 ahead.
        // Known failing: XPBD's static friction slips fully or not at all, so the slide starts
        // differently.
        EXPECT_NEAR(way, 0.5 * a, GetParam() == "xpbd" ? 0.01 : 0.5 * a * h + 1e-4);
        EXPECT_NEAR(glm::dot(particle_velocity(world, 0), down), a,
                    1e-3 * a + left * std::sin(angle));
    }
}

// Contacts act on both: momenta are conserved when particles strike spinning free bodies.
TEST_P(ParticleContacts, KeepMomenta) {
    Random random(11);
    for (int trial = 0; trial < 20; ++trial) {
        StepSettings settings = weightless(settings_for(GetParam()));
        settings.dt = 1.0 / 240;
        World world(GetParam(), settings);
        BodyDef def = dynamic_body(ball(0.3), 1.5, V{0, 0, 0}, any_vector(random, 0.3));
        def.angular_velocity = narrow(any_vector(random, 4));
        world.add_body(with_material(def, 0.6, 0.3));
        for (int i = 0; i < 6; ++i) {
            const V from = glm::normalize(any_vector(random, 1)) * 0.7;
            world.add_particle(grain_at(from, -3.0 * from + any_vector(random, 0.3)));
        }
        const Measures before = world.measure();
        const V spin = spin_of(world, world.body_id(0));
        run(world, 120);
        const Measures after = world.measure();
        EXPECT_NE(spin_of(world, world.body_id(0)), spin);
        // Known failing: AVBD positions bodies one after the other, so momenta are conserved only
        // as far as its passes converge: each particle brings 3 m/s and is sent back.
        const double left =
            GetParam() == "avbd" ? left_by_avbd(world) * 6 * 2 * 3 * particle_mass : 0;
        EXPECT_LT(glm::distance(after.linear_momentum, before.linear_momentum),
                  200 * epsilon + left);
        // XPBD loses spin, and corrects poses with first-order lever arms and rotations: at most
        // 9e-5 here, of some 0.3 (kg m^2/s). AVBD's are first order too, in a substep twenty times
        // as long.
        const double first = 1.4e-4;
        const double bound = GetParam() == "xpbd"   ? first
                             : GetParam() == "avbd" ? 20 * first
                                                    : 400 * epsilon;
        EXPECT_LT(glm::distance(after.angular_momentum, before.angular_momentum), bound);
        EXPECT_LT(after.kinetic_energy, before.kinetic_energy);
    }
}

TEST_P(ParticleContacts, BounceAtTheirRestitution) {
    for (const double e : {0.5, 0.8}) {
        World world(GetParam(), weightless(settings_for(GetParam())));
        world.add_body(ground(0, e));
        world.add_particle(grain_at(V{0, 1, 0}, V{1, -4, 0}));
        run(world, 60);
        EXPECT_NEAR(particle_velocity(world, 0).y, 4 * e, 1e-4);
        EXPECT_NEAR(particle_velocity(world, 0).x, 1, 1e-5);
    }
}

// It rebounds to its height times the square of its restitution, every time, wherever in a substep
// it strikes. Published methods fall by semi-implicit Euler, whose heights are off by g h of the
// speed.
TEST_P(ParticleContacts, ComeBackToTheirHeight) {
    const double fall = 0.5;
    for (const double e : {0.7, 1.0})
        for (const double dt : {1.0 / 60, 1.0 / 73, 1.0 / 240}) {
            StepSettings settings = settings_for(GetParam());
            settings.dt = dt;
            World world(GetParam(), settings);
            world.add_body(ground(0, e));
            world.add_particle(grain_at(V{0, particle_radius + fall, 0}));
            double speed = std::sqrt(2 * gravity * fall);
            double left = 1, off = 0; // shares
            for (int bounce = 1; bounce <= 3; ++bounce) {
                for (int i = 0; i < 400 && particle_velocity(world, 0).y <= 0; ++i)
                    world.step(nullptr);
                const double height = world.energy() / (particle_mass * gravity) - particle_radius;
                left *= e * e;
                off += gravity * substep_of(world) / speed;
                speed *= e;
                const double bound = GetParam() == "soft_step" ? 100 * epsilon
                                     : GetParam() == "avbd"    ? 4 * off
                                                               : 1.2 * off;
                EXPECT_NEAR(height / fall / left, 1, bound) << e << ' ' << 1 / dt << ' ' << bounce;
                for (int i = 0; i < 400 && particle_velocity(world, 0).y > 0; ++i)
                    world.step(nullptr);
            }
        }
}

// A net above the ground with a ball in it.
World trampoline(const std::string &method, int iterations, double damping) {
    StepSettings settings = settings_for(method);
    settings.iterations = iterations;
    World world(method, settings);
    world.add_body(ground(0.5, 0, V{0, 1, 0}));
    add_net(world, {.n = 15,
                    .side = 2,
                    .middle = {0, 1.5, 0},
                    .mass = 2,
                    .stiffness = 500,
                    .damping = damping});
    world.add_body(dynamic_body(ball(0.3), 3, V{0, 2.2, 0}));
    return world;
}

// The springs' pull on the frame, as a share of the weight of ball and net.
double borne(const World &world) {
    double pull = 0, weight = 3 * gravity;
    const std::vector<Particle> &particles = world.model().particles;
    for (const Particle &particle : particles)
        weight += particle.inv_mass > 0 ? double(particle.mass) * gravity : 0;
    for (const Spring &one : world.model().springs) {
        const V line =
            particle_position(world, one.b.index) - particle_position(world, one.a.index);
        const double length = glm::length(line);
        const double force = double(one.stiffness) * (length - double(one.rest_length));
        const bool a_pinned = particles[one.a.index].inv_mass == 0;
        const bool b_pinned = particles[one.b.index].inv_mass == 0;
        if (a_pinned != b_pinned)
            pull += force * (a_pinned ? -line.y : line.y) / length;
    }
    return pull / weight;
}

// At rest the springs carry the ball. That takes passes: a heavy ball rests on light particles
// between stiff springs. Known failings: with one pass per substep TGS Soft stretches the net until
// it would carry more than twice the weight; so, to a lesser degree, does sequential impulses with
// sixteen, whose substep is the whole step.
TEST_P(ParticleContacts, ANetBearsABall) {
    World world = trampoline(GetParam(), 16, 5);
    run(world, 1200);
    if (GetParam() == "sequential_impulses") {
        EXPECT_GT(borne(world), 1.2);
        return;
    }
    const double speed = glm::length(velocity_of(world, world.body_id(1)));
    if (GetParam() == "nncg") { // sixteen conjugated passes leave the ball bobbing
        EXPECT_GT(speed, 0.03);
        // On average it carries the ball, plus a few hundredths that only push out penetration.
        const int steps = 600;
        double sum = 0, height = 0;
        for (int i = 0; i < steps; ++i) {
            run(world, 1);
            sum += borne(world);
            height += position_of(world, world.body_id(1)).y;
        }
        EXPECT_NEAR(sum / steps, 1.05, 0.05);
        EXPECT_GT(height / steps, 1.3);
        return;
    }
    EXPECT_GT(position_of(world, world.body_id(1)).y, 1.3);
    EXPECT_LT(speed, 0.03);
    EXPECT_NEAR(borne(world), 1, 0.02);
    if (GetParam() == "tgs_soft") {
        World coarse = trampoline(GetParam(), 1, 5);
        run(coarse, 1200);
        EXPECT_GT(borne(coarse), 2);
    }
}

// A ball bouncing on a net, and on stiffer and lighter nets and with other steps: the net takes as
// many substeps as its springs need, and nothing gains energy.
TEST(SoftStepNet, GainsNoEnergy) {
    struct Net {
        double stiffness, mass, dt;
    };
    constexpr double ball_mass = 3, drop = 0.7;
    for (const Net &net :
         {Net{500, 0.5, 1.0 / 60}, Net{500, 0.05, 1.0 / 60}, Net{5000, 0.5, 1.0 / 60},
          Net{500, 0.5, 1.0 / 30}, Net{2000, 0.1, 1.0 / 120}}) {
        StepSettings settings = settings_for("soft_step");
        settings.dt = net.dt;
        World world("soft_step", settings);
        add_net(world,
                {.n = 9, .side = 2, .mass = net.mass, .stiffness = net.stiffness, .damping = 0.1});
        world.add_body(dynamic_body(ball(0.3), ball_mass, V{0, 0.3 + drop, 0}));
        const double before = world.energy();
        double most = before;
        for (int i = 0; i < int(3 / net.dt); ++i) {
            run(world, 1);
            most = std::max(most, world.energy());
        }
        EXPECT_LT(most - before, 1e-3 * ball_mass * gravity * drop)
            << net.stiffness << ' ' << net.mass << ' ' << net.dt;
    }
}

TEST_P(ParticleContacts, SameBitsSavedRestoredAndWithThreads) {
    World alone = trampoline(GetParam(), 4, 1), shared = trampoline(GetParam(), 4, 1);
    TaskPool tasks(4);
    SavedWorld saved;
    std::uint32_t contacts = 0;
    for (int i = 0; i < 80; ++i) {
        alone.step(nullptr);
        shared.step(&tasks);
        contacts = std::max(contacts, shared.report().particle_contacts);
        ASSERT_EQ(alone.hash(), shared.hash()) << i;
        if (i == 40)
            alone.save(saved);
    }
    const std::uint64_t end = alone.hash();
    alone.restore(saved);
    ASSERT_NE(alone.hash(), end);
    run(alone, 39);
    EXPECT_EQ(alone.hash(), end);
    EXPECT_GT(contacts, 4U);
}

// Bodies that particles touch or springs hold sleep when all particles are at rest, and wake when
// they move.
TEST(ParticleSleep, FollowsTheParticles) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.5, 0));
    const BodyId box = world.add_body(dynamic_body(block(V{0.3, 0.2, 0.3}), 5, V{0, 0.2, 0}));
    const BodyId tied = world.add_body(dynamic_body(block(V{0.3, 0.2, 0.3}), 5, V{3, 0.2, 0}));
    world.add_particle(grain_at(V{0, 0.4 + particle_radius, 0}));
    world.add_particle(particle_at(V{3, 2, 0}, 0.2));
    world.add_spring(spring(of_world(V{3, 2.5, 0}), of_particle(1), 0.5, 200, 5));
    world.add_spring(spring(of_particle(1), of_body(tied, V{0, 0.2, 0}), 1.6, 20, 1));
    const auto sleeps = [&](BodyId id) { return world.state().paces[id.index].is_asleep(); };
    run(world, 600);
    ASSERT_TRUE(sleeps(box) && sleeps(tied));
    const V on_box = particle_position(world, 0);
    run(world, 60);
    EXPECT_EQ(particle_position(world, 0), on_box);
    world.grab_particle(0, narrow(on_box + V{0.1, 0, 0}), Real(100));
    run(world, 2);
    EXPECT_TRUE(!sleeps(box) && sleeps(tied));
    world.release();
    run(world, 600);
    ASSERT_TRUE(sleeps(box) && sleeps(tied));
    world.grab_particle(1, narrow(V{3, 2.3, 0}), Real(100));
    run(world, 2);
    EXPECT_TRUE(sleeps(box) && !sleeps(tied));
}

// A thousand particles over five hundred bodies: each only meets nearby bodies.
TEST(ParticleContactCount, IsOfWhatIsNear) {
    World world("soft_step", settings_for("soft_step"));
    for (int i = 0; i < 500; ++i)
        world.add_body(static_body(ball(0.2), V{0.5 * (i % 25), 0, 0.5 * (i / 25)}));
    for (int i = 0; i < 1000; ++i) {
        ParticleDef def = particle_at(V{0.3 * (i % 40), 0.23, 0.4 * (i / 40)});
        world.add_particle(def);
    }
    run(world, 1);
    EXPECT_LT(world.report().particle_contacts, 2000U);
    EXPECT_GT(world.report().particle_contacts, 10U);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
