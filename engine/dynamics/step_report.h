// What one step did, and how long it took.
#pragma once

#include <cstdint>

namespace plumb {

// Work is counted as it is done.
struct StepReport {
    std::uint64_t body_passes = 0;       // bodies moved, summed over substeps
    std::uint64_t constraint_passes = 0; // contacts and joint blocks solved or warm-started
    std::uint32_t moving_bodies = 0;
    std::uint32_t pairs = 0;    // whose boxes overlap
    std::uint32_t contacts = 0; // of shapes that touch, or nearly
    std::uint32_t contact_points = 0;
    std::uint32_t joints = 0;
    std::uint32_t springs = 0;           // not torn
    std::uint32_t particle_contacts = 0; // of particles with bodies, touching or nearly
    std::uint32_t impacts = 0;           // bounces, and blows without one
    // Substeps whose last allowed sweep still bounced something.
    std::uint32_t unresolved_impacts = 0;
    bool finite = true; // all positions and velocities
};

// Wall time of each phase (s), measured on request.
struct StepTimes {
    double find_pairs = 0;
    double collide = 0;
    double advance = 0;
    double finish = 0;
    double total() const { return find_pairs + collide + advance + finish; }
};

} // namespace plumb
