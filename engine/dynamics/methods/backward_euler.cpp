// Backward (implicit) Euler for particles, springs and free bodies, linearised once a substep:
// (M - h df/dv - h^2 df/dx) dv = h (f + h df/dx v), by sparse Cholesky factors (Baraff and
// Witkin 1998, "Large Steps in Cloth Simulation", eq. (6)). First order; stable for any step:
// motion that the step cannot resolve is damped. Torques of free spin stay explicit.
//
// Across its line a loaded spring's stiffness is its force over its length. Under compression that
// is negative and is taken as 0, so that the matrix stays positive definite (Choi and Ko 2002,
// "Stable but Responsive Cloth", section 4). An attractor pulls harder the nearer it is, which is a
// negative stiffness too; only as much of it is used as leaves the matrix half of the mass.
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

using Unknowns = ImplicitSystem::Unknowns;
constexpr int no_unknown = -1;

// The system of one substep.
class System {
  public:
    System(StepContext &context, const Accelerations &now, double h)
        : context_(context), memory_(context.scratch.implicit_system), h_(h) {
        find_unknowns();
        memory_.entries.clear();
        add_masses(now);
        for (std::size_t i = 0; i < context.model.springs.size(); ++i)
            if (context.torn[i] == 0)
                add(context.model.springs[i]);
    }

    void solve() {
        if (memory_.sides.empty())
            return; // everything is locked, pinned or kinematic
        memory_.matrix.factor(static_cast<int>(memory_.sides.size()), memory_.entries);
        memory_.matrix.solve(memory_.sides);
        for (const std::uint32_t i : context_.moving()) {
            context_.bodies[i].velocity += change(memory_.bodies[i], 0);
            context_.bodies[i].angular_velocity += change(memory_.bodies[i], 3);
        }
        for (std::size_t i = 0; i < context_.particles.size(); ++i)
            context_.particles[i].velocity += change(memory_.particles[i], 0);
    }

  private:
    static constexpr Unknowns all_none() {
        return {no_unknown, no_unknown, no_unknown, no_unknown, no_unknown, no_unknown};
    }

    void find_unknowns() {
        int count = 0;
        memory_.bodies.assign(context_.bodies.size(), all_none());
        for (const std::uint32_t i : context_.moving())
            if (const Body &body = context_.model.bodies[i]; body.kind == BodyKind::dynamic)
                for (std::size_t axis = 0; axis < 6; ++axis)
                    if (!body.locked[axis])
                        memory_.bodies[i][axis] = count++;
        memory_.particles.assign(context_.particles.size(), all_none());
        for (std::size_t i = 0; i < context_.particles.size(); ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (context_.model.particles[i].inv_mass > Real(0))
                    memory_.particles[i][axis] = count++;
        memory_.sides.assign(static_cast<std::size_t>(count), 0.0);
    }

    Vec3 change(const Unknowns &unknowns, std::size_t first) const {
        Vec3 sum{Real(0)};
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (const int unknown = unknowns[first + axis]; unknown != no_unknown)
                sum[static_cast<int>(axis)] =
                    static_cast<Real>(memory_.sides[static_cast<std::size_t>(unknown)]);
        return sum;
    }

    void add_entry(int row, int column, double value) {
        if (column != no_unknown && row >= column)
            memory_.entries.push_back({row, column, value});
    }
    void add_side(int row, double value) {
        if (row != no_unknown)
            memory_.sides[static_cast<std::size_t>(row)] += value;
    }

    // Masses and damping on the diagonal, h M a on the right.
    void add_masses(const Accelerations &now) {
        const auto moving = context_.moving();
        for (std::size_t place = 0; place < moving.size(); ++place) {
            const Body &body = context_.model.bodies[moving[place]];
            if (body.kind != BodyKind::dynamic)
                continue;
            const Unknowns &own = memory_.bodies[moving[place]];
            const auto mass = static_cast<double>(body.mass);
            const double linear = 1 + h_ * static_cast<double>(body.linear_damping);
            const double angular = 1 + h_ * static_cast<double>(body.angular_damping);
            const glm::dmat3 axes =
                glm::mat3_cast(glm::dquat{context_.bodies[moving[place]].rotation});
            const glm::dvec3 moments{body.inertia};
            const glm::dmat3 inertia =
                glm::dmat3{axes[0] * moments.x, axes[1] * moments.y, axes[2] * moments.z} *
                glm::transpose(axes);
            if (!context_.model.attractors.empty())
                add_attraction(own, mass * static_cast<double>(body.gravity_scale),
                               glm::dvec3{context_.bodies[moving[place]].position},
                               glm::dvec3{context_.bodies[moving[place]].velocity});
            const glm::dvec3 torque = inertia * glm::dvec3{now.bodies[place].angular};
            for (int i = 0; i < 3; ++i) {
                const auto row = static_cast<std::size_t>(i);
                add_entry(own[row], own[row], mass * linear);
                add_side(own[row], h_ * mass * static_cast<double>(now.bodies[place].linear[i]));
                for (int j = 0; j < 3; ++j)
                    add_entry(own[3 + row], own[3 + static_cast<std::size_t>(j)],
                              angular * inertia[j][i]);
                add_side(own[3 + row], h_ * torque[i]);
            }
        }
        for (std::size_t i = 0; i < context_.particles.size(); ++i) {
            const auto mass = static_cast<double>(context_.model.particles[i].mass);
            if (!context_.model.attractors.empty())
                add_attraction(memory_.particles[i], mass,
                               glm::dvec3{context_.particles[i].position},
                               glm::dvec3{context_.particles[i].velocity});
            for (std::size_t axis = 0; axis < 3; ++axis) {
                add_entry(memory_.particles[i][axis], memory_.particles[i][axis], mass);
                add_side(memory_.particles[i][axis],
                         h_ * mass * static_cast<double>(now.particles[i][static_cast<int>(axis)]));
            }
        }
    }

    // -h^2 df/dx in the matrix, h^2 df/dx v on the right.
    void add_attraction(const Unknowns &own, double mass, const glm::dvec3 &x,
                        const glm::dvec3 &v) {
        const glm::dmat3 change =
            h_ * h_ * mass * attraction_gradient(context_.model.attractors, x, 0.5 / (h_ * h_));
        const glm::dvec3 side = change * v;
        for (int i = 0; i < 3; ++i) {
            const auto row = static_cast<std::size_t>(i);
            add_side(own[row], side[i]);
            for (int j = 0; j < 3; ++j)
                add_entry(own[row], own[static_cast<std::size_t>(j)], -change[j][i]);
        }
    }

    struct End {
        Unknowns unknowns;
        std::array<glm::dvec3, 6> effects; // per unknown: its effect on the end's velocity
    };
    End end_of(const SpringEnd &end, const SpringPoint &point) const {
        End out{all_none(), {}};
        if (end.kind == SpringEnd::Kind::particle)
            out.unknowns = memory_.particles[end.index];
        if (end.kind == SpringEnd::Kind::body)
            out.unknowns = memory_.bodies[end.index];
        for (int i = 0; i < 3; ++i) {
            glm::dvec3 axis{0};
            axis[i] = 1;
            out.effects[static_cast<std::size_t>(i)] = axis;
            out.effects[static_cast<std::size_t>(i) + 3] = glm::cross(axis, glm::dvec3{point.arm});
        }
        return out;
    }

    void add(const Spring &spring) {
        const SpringPoint a = spring_point(spring.a, context_.bodies, context_.particles);
        const SpringPoint b = spring_point(spring.b, context_.bodies, context_.particles);
        const glm::dvec3 line = glm::dvec3{b.position} - glm::dvec3{a.position};
        const double length = glm::length(line);
        if (!(length > 0))
            return;
        const glm::dvec3 n = line / length;
        const auto k = static_cast<double>(spring.stiffness);
        const double across =
            k * std::max(0.0, 1 - static_cast<double>(spring.rest_length) / length);
        const double along = k - across;
        const double damping = static_cast<double>(spring.damping);
        const auto stiff = [&](const glm::dvec3 &v) {
            return across * v + along * glm::dot(n, v) * n;
        };
        const glm::dvec3 pull = -h_ * h_ * stiff(glm::dvec3{b.velocity} - glm::dvec3{a.velocity});
        const std::array<End, 2> ends{end_of(spring.a, a), end_of(spring.b, b)};
        for (std::size_t one = 0; one < 2; ++one)
            for (std::size_t i = 0; i < 6; ++i) {
                const int row = ends[one].unknowns[i];
                if (row == no_unknown)
                    continue;
                const glm::dvec3 &effect = ends[one].effects[i];
                add_side(row, (one == 0 ? -1 : 1) * glm::dot(effect, pull));
                const glm::dvec3 response =
                    h_ * h_ * stiff(effect) + h_ * damping * glm::dot(n, effect) * n;
                for (std::size_t other = 0; other < 2; ++other)
                    for (std::size_t j = 0; j < 6; ++j)
                        add_entry(row, ends[other].unknowns[j],
                                  (one == other ? 1 : -1) *
                                      glm::dot(response, ends[other].effects[j]));
            }
    }

    StepContext &context_;
    ImplicitSystem &memory_;
    double h_;
};

// Without springs and attractors each body can be solved by itself.
void kick_free_bodies(StepContext &context, const Accelerations &now, Real h) {
    for (std::size_t place = 0; place < context.moving().size(); ++place) {
        const std::uint32_t i = context.moving()[place];
        const Body &body = context.model.bodies[i];
        if (body.kind != BodyKind::dynamic)
            continue;
        context.bodies[i].velocity +=
            (h / (Real(1) + h * body.linear_damping)) * now.bodies[place].linear;
        context.bodies[i].angular_velocity +=
            (h / (Real(1) + h * body.angular_damping)) * now.bodies[place].angular;
    }
}

void advance_backward_euler(StepContext &context) {
    const StepSettings &settings = context.settings;
    const double h = settings.dt / settings.substeps;
    Accelerations &now = context.scratch.accelerations[0];
    for (int substep = 0; substep < settings.substeps; ++substep) {
        find_accelerations(context, now);
        if (context.active.has_particles || !context.model.attractors.empty())
            System(context, now, h).solve();
        else
            kick_free_bodies(context, now, static_cast<Real>(h));
        drift_smoothly(context, static_cast<Real>(h));
    }
}

} // namespace

Method backward_euler() {
    return {{.name = "backward_euler",
             .title = "Backward Euler",
             .source = "Baraff and Witkin 1998, Large Steps in Cloth Simulation",
             .contacts = false,
             .joints = false,
             .springs = true,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance_backward_euler};
}

} // namespace plumb::inline PLUMB_PRECISION
