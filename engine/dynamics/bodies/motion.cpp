#include "engine/dynamics/bodies/motion.h"

#include "engine/core/check.h"
#include "engine/dynamics/bodies/drive.h"
#include "engine/dynamics/method.h"

#include <array>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <type_traits>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The Cayley map of the turn h * spin: the unit quaternion along (1, h spin / 2). It is the only
// map under which the midpoint rule keeps the world angular momentum exactly (Austin,
// Krishnaprasad, Wang 1993, "Almost Poisson Integration of Rigid Body Systems", sec. 4).
Quat cayley(const Vec3 &spin, Real h) {
    const Vec3 v = (Real(0.5) * h) * spin;
    return glm::normalize(Quat{Real(1), v.x, v.y, v.z});
}

// Rotates `v` by a quaternion that round-off has left not quite unit, in double precision, so that
// a round trip keeps the vector's length up to unbiased rounding. Otherwise whatever spins or rolls
// gains or loses energy with every substep.
Vec3 turned_to_rounding(const Quat &rotation, const Vec3 &v) {
    const glm::dquat q{rotation};
    const glm::dvec3 axis{q.x, q.y, q.z};
    const glm::dvec3 wide{v};
    const glm::dvec3 aside = glm::cross(axis, wide);
    return Vec3{wide + 2.0 / glm::dot(q, q) * (q.w * aside + glm::cross(axis, aside))};
}

// The second half of such a round trip. In double what is gained or lost is too little to matter.
Vec3 turned_back(const Quat &rotation, const Vec3 &v) {
    if constexpr (std::is_same_v<Real, double>)
        return rotated(rotation, v);
    else
        return turned_to_rounding(rotation, v);
}

} // namespace

Mat3 world_inverse_inertia(const Quat &rotation, const Vec3 &inv_inertia) {
    if (is_isotropic(inv_inertia))
        return Mat3{inv_inertia.x};
    const Mat3 r = glm::mat3_cast(rotation);
    const Mat3 scaled{r[0] * inv_inertia.x, r[1] * inv_inertia.y, r[2] * inv_inertia.z};
    const auto entry = [&](int i, int j) {
        return scaled[0][i] * r[0][j] + scaled[1][i] * r[1][j] + scaled[2][i] * r[2][j];
    };
    const Real xy = entry(0, 1);
    const Real xz = entry(0, 2);
    const Real yz = entry(1, 2);
    return {entry(0, 0), xy, xz, xy, entry(1, 1), yz, xz, yz, entry(2, 2)};
}

Vec3 spin_momentum(const Quat &rotation, const Vec3 &inertia, const Vec3 &angular_velocity) {
    return rotation * (inertia * (glm::conjugate(rotation) * angular_velocity));
}

Vec3 rotation_vector(const Quat &rotation) {
    const AxisAngle about = axis_angle(rotation);
    return about.angle * about.axis;
}

namespace {

// The unit quaternion of a turn: `v`, and one minus its scalar part.
struct Turn {
    Vec3 v{Real(0)};
    Real less = Real(0);
};

inline Turn turn_in(const Vec3 &angular_velocity, Real h, Real squared_angle) {
    // The sine of half the angle over the angle.
    Real sine = Real(0);
    Real less = Real(0);
    // Below this the terms left out of the series are below rounding.
    constexpr Real near = std::numeric_limits<Real>::digits > 24 ? Real(1e-5) : Real(1e-2);
    if (squared_angle < near) {
        const Real x = Real(0.25) * squared_angle;
        sine = Real(0.5) - x * (Real(1) / 12 - x * (Real(1) / 240));
        less = x * (Real(0.5) - x * (Real(1) / 24 - x * (Real(1) / 720)));
    } else {
        const Real angle = std::sqrt(squared_angle);
        const Real quarter = std::sin(Real(0.25) * angle);
        sine = std::sin(Real(0.5) * angle) / angle;
        less = Real(2) * quarter * quarter;
    }
    return {(sine * h) * angular_velocity, less};
}

} // namespace

Quat turned(const Quat &rotation, const Vec3 &angular_velocity, Real h) {
    const Real squared = glm::dot(angular_velocity, angular_velocity) * (h * h);
    if (squared == Real(0))
        return rotation;
    const Turn turn = turn_in(angular_velocity, h, squared);
    return glm::normalize(Quat{Real(1) - turn.less, turn.v.x, turn.v.y, turn.v.z} * rotation);
}

void turn(Motion &motion, RoundedOff &rounded_off, Real h) {
    const Vec3 &spin = motion.angular_velocity;
    const Real squared = glm::dot(spin, spin) * (h * h);
    if (squared == Real(0))
        return;
    const Turn turn = turn_in(spin, h, squared);
    const Quat way = Quat{-turn.less, turn.v.x, turn.v.y, turn.v.z} * motion.rotation;
    const Quat whole = way + rounded_off.rotation;
    const Quat to = motion.rotation + whole;
    rounded_off.rotation = whole - (to - motion.rotation);
    motion.rotation = to;
    constexpr Real off = Real(8) * std::numeric_limits<Real>::epsilon();
    if (std::abs(glm::dot(to, to) - Real(1)) > off) {
        motion.rotation = glm::normalize(to);
        rounded_off.rotation = RoundedOff{}.rotation;
    }
}

namespace {

// With equal moments about axes i and j (i, j, k in cyclic order): the spin about k stays, and the
// midpoint rule turns the rest by the Cayley map.
Vec3 symmetric_spin(const Vec3 &inertia, const Vec3 &spin, Real h, int i, int j, int k) {
    const Real c = Real(0.5) * h * (inertia[i] - inertia[k]) / inertia[i] * spin[k];
    const Real turn = Real(2) * c / (Real(1) + c * c);
    Vec3 end = spin;
    end[i] += turn * (spin[j] - c * spin[i]);
    end[j] -= turn * (spin[i] + c * spin[j]);
    return end;
}

} // namespace

Vec3 gyroscopic_spin(const Vec3 &inertia, const Vec3 &spin, Real h, int iterations) {
    for (int k = 0; k < 3 && iterations > 0; ++k)
        if (inertia[(k + 1) % 3] == inertia[(k + 2) % 3])
            return symmetric_spin(inertia, spin, h, (k + 1) % 3, (k + 2) % 3, k);
    const Vec3 torque =
        h * Vec3{inertia.z - inertia.y, inertia.x - inertia.z, inertia.y - inertia.x};
    const Vec3 half = Real(0.5) * torque;
    // After a step this small the error is below rounding: Newton squares it.
    const Real enough = std::numeric_limits<Real>::epsilon() / Real(8) * glm::dot(spin, spin);
    // Solve for the change, which is small and so are its rounding errors.
    Vec3 change{Real(0)};
    for (int i = 0; i < iterations; ++i) {
        const Vec3 mid = spin + Real(0.5) * change;
        const Vec3 residual =
            inertia * change + torque * Vec3{mid.y * mid.z, mid.z * mid.x, mid.x * mid.y};
        // Rows of d(residual)/d(change); mid changes by half the change.
        const Vec3 x{inertia.x, half.x * mid.z, half.x * mid.y};
        const Vec3 y{half.y * mid.z, inertia.y, half.y * mid.x};
        const Vec3 z{half.z * mid.y, half.z * mid.x, inertia.z};
        const Vec3 yz = glm::cross(y, z);
        const Vec3 step =
            (residual.x * yz + residual.y * glm::cross(z, x) + residual.z * glm::cross(x, y)) /
            glm::dot(x, yz);
        change -= step;
        if (glm::dot(step, step) <= enough)
            break;
    }
    // Turns of more than a radian need more iterations, and from two radians on Newton may diverge;
    // the energy is kept all the same.
    const Vec3 end = spin + change;
    const Real before = glm::dot(inertia * spin, spin);
    const Real after = glm::dot(inertia * end, end);
    constexpr Real rounding = Real(32) * std::numeric_limits<Real>::epsilon();
    if (!PLUMB_RARELY("gyroscopic spin did not converge",
                      !(std::abs(after - before) <= rounding * before)))
        return end;
    return std::isfinite(after) && after > Real(0) ? std::sqrt(before / after) * end : spin;
}

// With some rotations locked, the others turn against the inertia's block for their own axes: the
// inverse of that block, zeros elsewhere.
Mat3 solver_inverse_inertia(const Body &body, const Vec3 &inv_inertia, const Quat &rotation) {
    const Mat3 free = world_inverse_inertia(rotation, inv_inertia);
    if (!body.has_locks)
        return free;
    std::array<bool, 3> locked{body.locked[3], body.locked[4], body.locked[5]};
    if (!locked[0] && !locked[1] && !locked[2])
        return free;
    Mat3 inertia = glm::inverse(free);
    for (int i = 0; i < 3; ++i)
        if (locked[static_cast<std::size_t>(i)])
            for (int j = 0; j < 3; ++j)
                inertia[i][j] = inertia[j][i] = i == j ? Real(1) : Real(0);
    Mat3 inverse = glm::inverse(inertia);
    for (int i = 0; i < 3; ++i)
        if (locked[static_cast<std::size_t>(i)])
            inverse[i][i] = Real(0);
    return inverse;
}

bool has_gyroscopic_spin(const Body &body) {
    const bool is_held = body.has_locks && (body.locked[3] || body.locked[4] || body.locked[5]);
    return !is_isotropic(body.inertia) && !is_held;
}

namespace {

// Mean and end of a torque-free, damped turn that begins with flight.start_spin.
void turn_freely(FreeFlight &flight, const Body &body, const Damped &angular, Real h,
                 int gyroscopic_iterations) {
    const Vec3 undamped =
        gyroscopic_spin(body.inertia, flight.start_spin, h, gyroscopic_iterations);
    flight.end_spin = angular.kept * undamped;
    flight.mean_spin = angular.mean_kept * (Real(0.5) * (flight.start_spin + undamped));
}

inline FreeFlight begin_driven(SolverBody &motion, const Body &body, const Drive &drive, Real h,
                               Kick kick, int gyroscopic_iterations) {
    FreeFlight flight;
    flight.mean_velocity = motion.velocity;
    if (drive.is_dynamic) {
        const Damped &angular = drive.angular;
        flight.mean_velocity = drive.mean_kept * motion.velocity + drive.mean_gain;
        const Vec3 late = drive.late_kept * motion.velocity + drive.late_gain;
        flight.late_velocity = kick == Kick::around ? late : Vec3{Real(0)};
        motion.velocity =
            kick == Kick::around ? flight.mean_velocity : drive.kept * motion.velocity + drive.gain;
        if (drive.is_gyroscopic) {
            flight.start_spin =
                turned_to_rounding(glm::conjugate(motion.rotation), motion.angular_velocity);
            turn_freely(flight, body, angular, h, gyroscopic_iterations);
            motion.angular_velocity = turned_back(
                motion.rotation, kick == Kick::around ? flight.mean_spin : flight.end_spin);
        } else if (body.angular_damping > Real(0)) {
            flight.late_spin = kick == Kick::around
                                   ? (angular.kept - angular.mean_kept) * motion.angular_velocity
                                   : Vec3{Real(0)};
            motion.angular_velocity *= kick == Kick::around ? angular.mean_kept : angular.kept;
        }
    }
    flight.velocity = motion.velocity;
    flight.angular_velocity = motion.angular_velocity;
    return flight;
}

} // namespace

FreeFlight begin_flight(SolverBody &motion, const Body &body, const Vec3 &gravity, Real h,
                        Kick kick, int gyroscopic_iterations) {
    return begin_driven(motion, body, drive_of(body, gravity, h), h, kick, gyroscopic_iterations);
}

namespace {

void go(SolverBody &motion, RoundedOff &rounded_off, const Vec3 &way) {
    const Vec3 whole = way + rounded_off.position;
    const Vec3 to = motion.position + whole;
    rounded_off.position = whole - (to - motion.position);
    motion.position = to;
    motion.moved += way;
}

// The pose after h, at the velocities that the body has now.
inline void move_along(SolverBody &motion, RoundedOff &rounded_off, const Body &body,
                       const FreeFlight &flight, Real h, bool is_gyroscopic) {
    const Vec3 way = h * (flight.free ? flight.mean_velocity : motion.velocity);
    go(motion, rounded_off, way);
    motion.turned += h * motion.angular_velocity;
    if (is_gyroscopic && flight.turns_by_mean)
        motion.rotation = glm::normalize(motion.rotation * cayley(flight.mean_spin, h));
    else
        turn(motion, rounded_off, h);
    if (body.kind == BodyKind::dynamic && !is_isotropic(body.inertia))
        motion.inv_inertia = solver_inverse_inertia(body, motion.rotation);
}

void note_freedom(FreeFlight &flight, const SolverBody &motion) {
    flight.free =
        motion.velocity == flight.velocity && motion.angular_velocity == flight.angular_velocity;
    flight.turns_by_mean = flight.free;
}

// Whether a turn (rad) is far enough for the timing of impulses within the substep to matter; saves
// the work for bodies that barely turn.
bool turns_far(const Vec3 &spin, Real h) {
    constexpr Real far = Real(1e-3);
    return glm::dot(spin, spin) * (h * h) > far * far;
}

} // namespace

// Between the two half kicks the gyroscopic torque is that of the spin that the solver left
// (`kick`): the first half of its impulses comes before the torque-free turn, as in RATTLE, and the
// turn keeps their energy. If added to the mean spin of a turn without them, they would do work: a
// top whose foot is held by a joint sinks, bodies on springs gain angular momentum, and a capsule
// spinning on a floor gains energy without end. Impacts are excluded: they act in an instant, and
// half of one there would be just as wrong.
void move_held(SolverBody &motion, RoundedOff &rounded_off, const Body &body, FreeFlight &flight,
               Real h, int gyroscopic_iterations, HeldBy held_by) {
    note_freedom(flight, motion);
    const bool is_gyroscopic = body.kind == BodyKind::dynamic && has_gyroscopic_spin(body);
    if (is_gyroscopic && !flight.free &&
        (held_by.joints || held_by.springs || (flight.loaded && turns_far(flight.start_spin, h)))) {
        flight.start_spin += rotated(glm::conjugate(motion.rotation),
                                     motion.angular_velocity - flight.angular_velocity);
        turn_freely(flight, body, damped(body.angular_damping, h), h, gyroscopic_iterations);
        motion.angular_velocity = turned_back(motion.rotation, flight.mean_spin);
        // Joints and contacts hold where the velocity leads.
        flight.turns_by_mean = held_by.springs && !held_by.joints && !flight.loaded;
    }
    move_along(motion, rounded_off, body, flight, h, is_gyroscopic);
}

void move(SolverBody &motion, RoundedOff &rounded_off, const Body &body, FreeFlight &flight,
          Real h) {
    note_freedom(flight, motion);
    move_along(motion, rounded_off, body, flight, h,
               body.kind == BodyKind::dynamic && has_gyroscopic_spin(body));
}

namespace {

inline void end_driven(SolverBody &motion, const FreeFlight &flight, Kick kick,
                       bool is_gyroscopic) {
    motion.velocity += flight.late_velocity;
    motion.angular_velocity += flight.late_spin;
    if (!is_gyroscopic)
        return;
    if (flight.free)
        motion.angular_velocity = turned_to_rounding(motion.rotation, flight.end_spin);
    else if (kick == Kick::around)
        motion.angular_velocity += rotated(motion.rotation, flight.end_spin - flight.mean_spin);
}

} // namespace

void end_flight(SolverBody &motion, const Body &body, const FreeFlight &flight, Kick kick) {
    end_driven(motion, flight, kick, body.kind == BodyKind::dynamic && has_gyroscopic_spin(body));
}

namespace {

// A few microseconds of work.
constexpr std::size_t bodies_a_part = 64;

void twist_bodies(StepContext &context, Real h) {
    if (context.model.bodies_with_torque == 0)
        return;
    for (const std::uint32_t i : context.moving())
        twist(context.bodies[i], context.model.bodies[i], h);
    context.report.body_passes += context.moving().size();
}

} // namespace

void attract_and_twist(StepContext &context, Real h) {
    attract_bodies(context, h);
    twist_bodies(context, h);
}

void begin_flights(StepContext &context, const Vec3 &gravity, Real h) {
    std::vector<FreeFlight> &flights = context.scratch.flights;
    attract_and_twist(context, h);
    flights.resize(context.moving().size());
    const auto begin_part = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = context.moving()[i];
            flights[i] = begin_flight(context.bodies[body], context.model.bodies[body], gravity, h,
                                      Kick::before, context.settings.gyroscopic_iterations);
        }
    };
    for_parts(context.tasks, flights.size(), bodies_a_part, begin_part);
    context.report.body_passes += flights.size();
}

void track_turn(SolverBody &motion, const Motion &start) {
    if (has_turned_far(motion.turned)) // a sum of turns about changing axes drifts
        motion.turned = rotation_vector(motion.rotation * glm::conjugate(start.rotation));
}

void end_flights(StepContext &context, Real h) {
    std::vector<FreeFlight> &flights = context.scratch.flights;
    const auto end_part = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t index = context.moving()[i];
            SolverBody &motion = context.bodies[index];
            const Body &body = context.model.bodies[index];
            move(motion, context.scratch.rounded_off[index], body, flights[i], h);
            track_turn(motion, context.starts[index]);
            end_flight(motion, body, flights[i], Kick::before);
        }
    };
    for_parts(context.tasks, flights.size(), bodies_a_part, end_part);
    context.report.body_passes += flights.size();
}

namespace {

// Position and velocity after any time of a body that nothing holds or touches: closed form.
void fly_along(SolverBody &motion, RoundedOff &rounded_off, const Drive &drive, Real time) {
    const Vec3 mean = drive.mean_kept * motion.velocity + drive.mean_gain;
    const Vec3 way = time * mean;
    motion.velocity = mean + (drive.late_kept * motion.velocity + drive.late_gain);
    go(motion, rounded_off, way);
}

// Half of the attractors' pull before each substep, half after. Returns passes over the body.
int fly_attracted(SolverBody &motion, const Body &body, const Vec3 &gravity,
                  const StepContext &context) {
    const Real h = context.substep();
    const Drive drive = drive_of(body, gravity, h);
    RoundedOff rounded_off;
    for (int substep = 0; substep < context.settings.substeps; ++substep) {
        attract(motion, body, context.model.attractors, Real(0.5) * h);
        fly_along(motion, rounded_off, drive, h);
        attract(motion, body, context.model.attractors, Real(0.5) * h);
    }
    return 3 * context.settings.substeps;
}

// A torque-free turn for `time` seconds, `substeps` times h: closed form about a constant axis,
// otherwise substep by substep with the spin kept in body axes. Returns passes over the body.
int turn_torque_free(SolverBody &motion, const Body &body, const Drive &drive, Real time, Real h,
                     int substeps, int iterations) {
    if (!drive.is_gyroscopic || motion.angular_velocity == Vec3{Real(0)}) {
        const Damped angular = drive.is_dynamic ? damped(body.angular_damping, time) : Damped{};
        const Vec3 mean = angular.mean_kept * motion.angular_velocity;
        motion.turned += time * mean;
        motion.rotation = turned(motion.rotation, mean, time);
        motion.angular_velocity *= angular.kept;
        return 1;
    }
    const Damped angular = damped(body.angular_damping, h);
    Vec3 spin = turned_to_rounding(glm::conjugate(motion.rotation), motion.angular_velocity);
    for (int substep = 0; substep < substeps; ++substep) {
        const Vec3 undamped = gyroscopic_spin(body.inertia, spin, h, iterations);
        const Vec3 mean = angular.mean_kept * (Real(0.5) * (spin + undamped));
        spin = angular.kept * undamped;
        motion.turned += h * rotated(motion.rotation, mean);
        motion.rotation = glm::normalize(motion.rotation * cayley(mean, h));
    }
    motion.angular_velocity = turned_to_rounding(motion.rotation, spin);
    motion.inv_inertia = solver_inverse_inertia(body, motion.rotation);
    return substeps;
}

// The rotation of a body alone; of a constant torque, half acts before each substep's turn, half
// after. Returns passes over the body.
int turn_alone(SolverBody &motion, const Body &body, const Drive &drive,
               const StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    const int iterations = settings.gyroscopic_iterations;
    if (!body.has_torque)
        return turn_torque_free(motion, body, drive, static_cast<Real>(settings.dt), h,
                                settings.substeps, iterations);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        twist(motion, body, Real(0.5) * h);
        turn_torque_free(motion, body, drive, h, h, 1, iterations);
        twist(motion, body, Real(0.5) * h);
    }
    return 3 * settings.substeps;
}

} // namespace

void fly_freely(StepContext &context, const Vec3 &gravity) {
    const auto dt = static_cast<Real>(context.settings.dt);
    const std::span<const std::uint32_t> moving = context.moving();
    const bool is_attracted = !context.model.attractors.empty();
    std::atomic<std::uint64_t> passes = 0;
    const auto fly_part = [&](std::size_t begin, std::size_t end) {
        std::uint64_t own_passes = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const Body &body = context.model.bodies[moving[i]];
            SolverBody &motion = context.bodies[moving[i]];
            const Drive drive = drive_of(body, gravity, dt);
            RoundedOff rounded_off; // for a single move: dropped
            int own = 1;
            if (is_attracted)
                own = fly_attracted(motion, body, gravity, context);
            else
                fly_along(motion, rounded_off, drive, dt);
            own += turn_alone(motion, body, drive, context);
            own_passes += static_cast<std::uint64_t>(own);
        }
        passes.fetch_add(own_passes, std::memory_order_relaxed);
    };
    for_parts(context.tasks, moving.size(), bodies_a_part, fly_part);
    context.report.body_passes += passes;
}

void kick(StepContext &context, const Vec3 &gravity, Real h) {
    attract_bodies(context, h);
    for (const std::uint32_t i : context.moving()) {
        const Body &body = context.model.bodies[i];
        SolverBody &motion = context.bodies[i];
        if (body.kind != BodyKind::dynamic)
            continue;
        motion.velocity =
            damped(body.linear_damping, h).kept * motion.velocity + h * pull_on(body, gravity);
        if (has_gyroscopic_spin(body)) {
            const Vec3 spin = rotated(glm::conjugate(motion.rotation), motion.angular_velocity);
            motion.angular_velocity =
                rotated(motion.rotation, gyroscopic_spin(body.inertia, spin, h,
                                                         context.settings.gyroscopic_iterations));
        }
        motion.angular_velocity *= damped(body.angular_damping, h).kept;
        twist(motion, body, h);
    }
    context.report.body_passes += context.moving().size();
}

void drift(StepContext &context, Real h) {
    for (const std::uint32_t i : context.moving()) {
        const Body &body = context.model.bodies[i];
        SolverBody &motion = context.bodies[i];
        motion.position += h * motion.velocity;
        turn(motion, context.scratch.rounded_off[i], h);
        if (body.kind == BodyKind::dynamic && !is_isotropic(body.inertia))
            motion.inv_inertia = solver_inverse_inertia(body, motion.rotation);
    }
    context.report.body_passes += context.moving().size();
}

} // namespace plumb::inline PLUMB_PRECISION
