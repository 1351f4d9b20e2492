// NNCG, the nonsmooth nonlinear conjugate gradient method: Silcowitz-Hansen, Niebe, Erleben 2010,
// "A nonsmooth nonlinear conjugate gradient method for interactive contact force problems", The
// Visual Computer 26, algorithm 1 (Fletcher and Reeves' beta, restarted wherever it exceeds 1). A
// pass of projected Gauss-Seidel takes the impulses from f to F(f); f - F(f) serves as the
// gradient, and the previous passes' direction is followed on as long as the gradient shrinks. So
// an error that Gauss-Seidel passes on from contact to contact, reducing it only a little per pass,
// is gone in about the square root of the passes. Everything else is as in sequential_impulses
// with its additions (the publication leaves it open), but that passes always run forwards.
#include "engine/dynamics/methods/parts/impulse_substeps.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Calls use(impulse, remembered) for each row's component, in order. After the warm start,
// `remembered` holds the search direction.
template <typename Use> void for_each_impulse(SolverScratch &scratch, Use &&use) {
    const auto use_all = [&](Vec3 &impulse, Vec3 &remembered) {
        for (int i = 0; i < 3; ++i)
            use(impulse[i], remembered[i]);
    };
    for (JointConstraint &joint : scratch.joints)
        use_all(joint.impulse, joint.remembered);
    for (ContactConstraint &contact : scratch.contacts)
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            use_all(point.impulse, point.remembered);
        }
    for (SpringConstraint &spring : scratch.springs)
        use(spring.impulse, spring.remembered);
    for (ParticleContactConstraint &contact : scratch.particle_contacts)
        use_all(contact.impulse, contact.remembered);
}

void go_on(StepContext &context, Real share) {
    warm_start_joints(context, share, Springs::at_the_end);
    warm_start_contacts(context, share);
    warm_start_particles(context, share);
}

// Ends with a pass, so that the impulses are within their bounds.
template <typename Pass> void search(StepContext &context, const Pass &pass) {
    SolverScratch &s = context.scratch;
    for_each_impulse(s, [](Real, Real &direction) { direction = Real(0); });
    double last = 0; // |F(f) - f|^2 of the previous pass
    for (int i = 0; i < context.settings.iterations; ++i) {
        std::vector<Real> &change = s.changes;
        change.clear();
        for_each_impulse(s, [&](Real impulse, Real) { change.push_back(impulse); });
        pass(PointOrder::forwards);
        double squared = 0;
        auto next = change.begin();
        for_each_impulse(s, [&](Real impulse, Real) {
            *next = impulse - *next;
            squared += static_cast<double>(*next) * static_cast<double>(*next);
            ++next;
        });
        if (squared == 0 || i + 1 == context.settings.iterations)
            return; // converged, or that was the last pass
        const bool shrinks = i > 0 && squared <= last;
        const Real beta = shrinks ? static_cast<Real>(squared / last) : Real(0);
        if (shrinks)
            go_on(context, beta);
        next = change.begin();
        const bool restarts = i > 0 && !shrinks;
        for_each_impulse(s, [&](Real, Real &direction) {
            direction = restarts ? Real(0) : beta * direction + *next;
            ++next;
        });
        last = squared;
    }
}

void advance_nncg(StepContext &context) {
    advance_by_impulses(context, [&](const auto &pass) { search(context, pass); });
}

} // namespace

Method nncg() {
    return {{.name = "nncg",
             .title = "NNCG",
             .source = "Silcowitz-Hansen, Niebe, Erleben 2010",
             .contacts = true,
             .joints = true,
             .springs = true,
             .reads = read_by_impulses(),
             .defaults = {.substeps = 1, .iterations = 50}},
            advance_nncg};
}

} // namespace plumb::inline PLUMB_PRECISION
