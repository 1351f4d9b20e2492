// Islands: bodies that act on each other within a step, through contacts and joints. Each takes as
// many substeps as its own loads ask for.
#pragma once

#include "engine/core/disjoint_sets.h"
#include "engine/core/precision.h"

#include <cstdint>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// A soft contact or joint gives way under its load by an amount that falls with the square of the
// substeps, and joints' forces make bodies so stiff that too long a substep cannot follow them.
// Both are known from the loads of the last step, so the number of substeps an island needs is
// known before a step, from the state alone.
//
// This is what a body remembers of that, and of its rest (sleep.cpp).
struct Pace {
    std::uint16_t substeps = 0; // of its island in the last step; 0: the settings'
    std::uint16_t wanted = 0;   // what its own loads ask for
    std::uint16_t rested = 0;   // steps it has been at rest, or `asleep`
    std::uint16_t struck = 0;   // steps in a row that it was struck (ContactBlock)
    static constexpr std::uint16_t asleep = 0xFFFF; // its island is not stepped any more
    bool is_asleep() const { return rested == asleep; }
};

// The speed below which a body or particle may be at rest (m/s): a share of what `pull` (m/s^2)
// adds in a 60th of a second, or in a step if that is longer.
double rest_speed(double pull, double dt);

// From this many times settings.substeps on, an island's loads are far more than its bodies' own
// weights.
inline constexpr int far_more_substeps = 8;

// How an island is stepped.
struct IslandPace {
    int substeps = 0;
    // Whether passes take a contact's points first to last and last to first in turns.
    bool alternates = true;
    // Whether it gets far fewer substeps than it wants: points that bear much become stiffer
    // (hard_share).
    bool hardens = false;
    // How many passes over the constraints, and relaxation passes, each substep takes on top of the
    // settings' own.
    int more_passes = 0;
    int more_relaxing = 0;  // how many more relaxation passes alone
    bool is_joined = false; // has joints
    // Whether heavier bodies strike a light one all the time (calm_push).
    bool is_shaken = false;
    // Whether it has joints and was struck in each step for longer than a single blow lasts.
    bool is_struck_long = false;
    // Whether all that the relaxation pass adds to a load is remembered (relaxed_again), or half.
    bool remembers_all() const { return !alternates || !hardens; }
    bool operator==(const IslandPace &) const = default;
};

// Islands that are stepped alike and that a method advances together. Indices into the context's
// arrays, each ascending.
struct IslandGroup {
    IslandPace pace;
    std::vector<std::uint32_t> moving;
    std::vector<std::uint32_t> contacts;
    std::vector<std::uint32_t> joints;
    bool holds_grab = false;
    bool has_particles = false; // all of them, with all springs

    void clear() {
        moving.clear();
        contacts.clear();
        joints.clear();
        holds_grab = has_particles = false;
    }
    // Whether no body is connected to another.
    bool is_free() const {
        return contacts.empty() && joints.empty() && !holds_grab && !has_particles;
    }
};

// The islands of a step, as sets of bodies. Kinematic bodies join what they touch, static ones do
// not.
struct Islands : DisjointSets {
    struct Needs {         // per root's island
        int work = 0;      // contacts and joints
        double weight = 0; // N, with the bodies' own forces, all added up in size
        int wanted = 0;
        int before = 0; // the most substeps that any of its bodies took in the last step
        bool rests = true;
        bool is_slow = true;
        bool is_shaken = false; // see IslandPace
        bool is_struck_long = false;
        bool touches = false;    // has contacts
        bool is_joined = false;  // has joints
        bool is_driven = false;  // pressed by more than weight
        bool was_let_go = false; // any of its joints was, see JointGroup
        IslandPace pace;
    };
    std::vector<Needs> needs;
    std::vector<std::uint32_t> roots; // of islands that have contacts or joints

    // See bracing.h.
    struct Bracing {   // per root's island
        int loops = 0; // contacts and joints, less the bodies; below 0: none
        bool has_joints = false;
        std::uint32_t hung = UINT32_MAX; // the body by which it hangs, if any
        bool is_bridge = false;          // hangs by several: under load from outside
        bool is_braced() const { return has_joints && loops >= 0 && !is_bridge; }
    };
    std::vector<Bracing> bracing;
};

// The least of 1 to 8, 10, 12, 14, 16, 20, ... (three binary digits) that is at least n: few
// counts, so that many islands are advanced together.
int round_substeps_up(int n);
int round_substeps_down(int n);
// The next count below a rounded n > 0; below other n, one about as far below.
int fewer_substeps(int n);

} // namespace plumb::inline PLUMB_PRECISION
