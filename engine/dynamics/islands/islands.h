// Islands: bodies that act on each other within a step, through contacts and joints. Each takes as
// many substeps as its own loads ask for.
#pragma once

#include "engine/core/precision.h"

#include <cstdint>
#include <numeric>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// A soft contact or joint gives way under its load by an amount that falls with the square of the
// substeps; and joints' forces make bodies so stiff that too long a substep cannot follow them.
// Both are known from what was borne in the last step, so how many substeps an island needs is
// known before a step, from the state alone.
//
// What a body remembers of that, and of its rest (sleep.cpp).
struct Pace {
    std::uint16_t substeps = 0; // of its island in the last step; 0: those of the settings
    std::uint16_t wanted = 0;   // what its own loads ask for
    std::uint16_t rested = 0;   // steps for which it has been at rest, or `asleep`
    static constexpr std::uint16_t asleep = 0xFFFF; // its island is not stepped any more
    bool is_asleep() const { return rested == asleep; }
};

// How an island is stepped.
struct IslandPace {
    int substeps = 0;
    // Whether passes take a contact's points from the first and from the last in turns.
    bool alternates = true;
    // Whether it takes another pass over its constraints in each substep, and relaxes once more.
    bool settles = false;
    bool operator==(const IslandPace &) const = default;
};

// Islands that are stepped alike: what a method advances at once. Indices of the context's, each
// ascending.
struct IslandGroup {
    IslandPace pace;
    std::vector<std::uint32_t> moving;
    std::vector<std::uint32_t> contacts;
    std::vector<std::uint32_t> joints;
    bool holds_grab = false;
    bool has_particles = false; // all of them, with all springs

    // Whether each of its bodies is by itself.
    bool is_free() const {
        return contacts.empty() && joints.empty() && !holds_grab && !has_particles;
    }
};

// The islands of a step, as trees of bodies. Kinematic bodies join what they touch, static ones do
// not.
struct Islands {
    std::vector<std::uint32_t> parent; // of each body; of a root itself
    struct Needs {                     // of a root's island
        int work = 0;                  // contacts and joints
        double mass = 0;               // kg
        int wanted = 0;
        int before = 0; // substeps of the last step, the most that any of its bodies took
        bool rests = true;
        bool is_slow = true;
        bool touches = false;    // has contacts
        bool is_joined = false;  // has joints
        bool was_let_go = false; // see JointGroup, of any of its joints
        IslandPace pace;
    };
    std::vector<Needs> needs;
    std::vector<std::uint32_t> roots; // of islands that have contacts or joints

    // Each body by itself.
    void start(std::size_t bodies) {
        parent.resize(bodies);
        std::iota(parent.begin(), parent.end(), std::uint32_t{0});
    }
    std::uint32_t root_of(std::uint32_t body) {
        while (parent[body] != body)
            body = parent[body] = parent[parent[body]];
        return body;
    }
    // The lesser root stays one, so that the trees depend on nothing but which are joined.
    void join(std::uint32_t a, std::uint32_t b) {
        a = root_of(a);
        b = root_of(b);
        if (a < b)
            parent[b] = a;
        else
            parent[a] = b;
    }
};

// The least of the numbers 1 to 8, 10, 12, 14, 16, 20, ... (three binary digits) that is not below
// n: few numbers, so that many islands are advanced at once.
int round_substeps_up(int n);
int round_substeps_down(int n);
// The next one below a rounded n > 0; below others, one about as far below.
int fewer_substeps(int n);

} // namespace plumb::inline PLUMB_PRECISION
