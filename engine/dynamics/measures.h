// Measurements of a world at one moment.
#pragma once

#include <glm/vec3.hpp>

namespace plumb {

struct Measures {
    double time = 0;           // s
    double kinetic_energy = 0; // J, of dynamic bodies and particles
    // J: gravity and constant forces, 0 at the world's origin; attractors, 0 far away; springs. The
    // work of a constant torque has no potential: it changes the energy.
    double potential_energy = 0;
    glm::dvec3 linear_momentum{0};  // kg m/s
    glm::dvec3 angular_momentum{0}; // kg m^2/s about the world's origin
    double max_penetration = 0;     // m, the deepest contact point at the present poses
    double mean_penetration = 0;    // m, mean over contact points that penetrate
    double max_joint_drift = 0;     // m, the worst joint error; 1 rad counts as 1 m
    double mean_joint_drift = 0;    // m
    double max_strain = 0;          // the largest |length / rest length - 1| of springs not torn
    // How far the bodies' contacts are from the laws of contact, by the forces of the last substep
    // and the velocities after it (Le Lidec et al. 2024, "Contact Models in Robotics: a Comparative
    // Analysis"). With the force (n, t) on b, normal and tangential, and the velocity (v, w) of b
    // relative to a at the point:
    double signorini_residual = 0;   // W, the largest |n v|: separating contacts are not pushed
    double cone_residual = 0;        // N, the largest |t| - mu n: friction stays in Coulomb's cone
    double dissipation_residual = 0; // W, the largest mu n |w| + t.w: sliding is slowed in full
    double contact_power = 0;        // W, sum of n v + t.w: contacts add no energy
    double energy() const { return kinetic_energy + potential_energy; }
};

} // namespace plumb
