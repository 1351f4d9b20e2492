// Everything that a step can be told, with units and reasons. No method has a constant of its own.
#pragma once

#include <glm/vec3.hpp>

namespace plumb {

struct StepSettings {
    glm::dvec3 gravity{0, -9.81, 0}; // m/s^2
    double dt = 1.0 / 60.0;          // s, one step
    int substeps = 4;                // the step is cut into so many; collision is found once a step
    int iterations = 1;              // passes over all constraints in each substep

    // Contacts closer than this are made before they touch, so that nothing falls into its
    // neighbour within a step (m). Bodies that approach each other get their relative motion on
    // top.
    double speculative_distance = 0.02;
    // Penetration that sequential impulses leave alone, so that contacts persist (m).
    double penetration_slop = 0.0005;
    // Fraction of the penetration (or of a joint's drift) that sequential impulses remove in a
    // substep (Baumgarte 1972).
    double baumgarte = 0.2;
    // Natural frequency of a soft contact as a fraction of the substep rate. Above 1/4 the spring
    // is under-sampled; 1/8 lets it settle between neighbours (Catto 2024, "Solver2D").
    double contact_frequency_ratio = 0.125;
    double contact_damping_ratio = 10;
    // Soft joints, likewise. Stiffer keeps a pendulum truer, and tears a chain of ten with a
    // hundredfold weight at its end apart at four substeps; 0.2 and 5 is the stiffest that holds
    // both.
    double joint_frequency_ratio = 0.2;
    double joint_damping_ratio = 5;
    // The fastest that overlapping bodies are pushed apart (m/s).
    double push_velocity = 3;
    // Slower impacts do not bounce, so that bodies come to rest (m/s).
    double restitution_threshold = 0.02;
    // An impact counts when it would happen within this many substeps. A hair less than one, and
    // the solver would stop the body before it bounces; a little early does no harm, as the rebound
    // accounts for the gap.
    double impact_lookahead = 1.1;
    // How often an impact may be handed on from contact to contact within one substep.
    int impact_sweeps = 32;
    // Gauss-Seidel passes by which the points of one manifold share an impact; four corners of a
    // box agree to float precision after about so many.
    int impact_passes = 16;
    // Newton steps for the implicit gyroscopic term; three reach rounding up to a third of a
    // radian a substep.
    int gyroscopic_iterations = 3;
};

} // namespace plumb
