// What one step did, and what it cost.
#pragma once

#include <cstdint>

namespace plumb {

struct StepReport {
    // Wall time of each phase (s).
    double find_pairs = 0;
    double collide = 0;
    double advance = 0;
    double finish = 0;
    double total() const { return find_pairs + collide + advance + finish; }

    std::uint32_t moving_bodies = 0;
    std::uint32_t pairs = 0;    // boxes overlap
    std::uint32_t contacts = 0; // shapes touch, or nearly
    std::uint32_t contact_points = 0;
    std::uint32_t joints = 0;
    std::uint32_t impacts = 0; // bounces resolved
    std::uint32_t unresolved_impacts =
        0; // substeps whose last allowed sweep still bounced something

    double energy = 0; // kinetic and potential, J
    double energy_gain =
        0;              // over the step, J; with nothing driving the world, more than 0 is an error
    bool finite = true; // all positions and velocities
};

} // namespace plumb
