// All settings of a step. Constants of a single method stay where they are used.
//
// A setting is a member of StepSettings and a row of setting_rows. Checks, the state hash, scene
// files, the command line, sweeps, the panel, charts and scenes/README.md are generated from the
// table, so a new setting is two entries in this file.
#pragma once

#include "engine/core/hash.h"

#include <array>
#include <compare>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <glm/vec3.hpp>

namespace plumb {

struct StepSettings {
    glm::dvec3 gravity{0, -9.81, 0};
    double dt = 1.0 / 60.0;
    int substeps = 4;       // methods set their own default in the registry
    int max_substeps = 1;   // see the registry
    double sleep_after = 0; // see the registry
    int iterations = 1;     // see the registry
    double substep_tolerance = 2e-4;
    int substep_budget = 8192;
    double speculative_distance = 0.02;
    double kept_travel = 0.005;
    double penetration_slop = 0.0005;
    double baumgarte = 0.2;
    int split_impulse = 1;
    double contact_frequency_ratio = 0.125;
    double contact_damping_ratio = 10;
    double joint_frequency_ratio = 0.2;
    double joint_damping_ratio = 5;
    double push_velocity = 3;
    double restitution_threshold = 0.02;
    double impact_lookahead = 1.1;
    int impact_sweeps = 32;
    int impact_passes = 16;
    int gyroscopic_iterations = 3;
    double penalty_start = 1;
    double penalty_growth = 100;
    double penalty_limit = 1e6;
    double penalty_kept = 0.99;
    double error_kept = 0.95;
};

// Settings that belong together: a method's row in the registry names the groups that it reads.
// Every method reads the first two.
enum class SettingGroup {
    world,       // the scene's: the same for all methods
    step,        // how any method divides a step
    chosen,      // each island's own substeps
    sleep,       // bodies at rest are not stepped
    constraints, // methods that solve contacts and joints
    speculative, // contacts made before bodies touch
    kept,        // manifolds kept while bodies rest against each other
    baumgarte,   // a share of each error removed per substep
    split,       // by pseudo velocities, or through the velocities
    soft,        // contacts and joints as springs
    push,        // the fastest that overlap is removed
    threshold,   // impacts too slow to bounce
    impacts,     // bounces, propagated from contact to contact
    gyroscopic,  // an implicit gyroscopic term
    penalty      // rows that stiffen while in error
};

using SettingMember =
    std::variant<double StepSettings::*, int StepSettings::*, glm::dvec3 StepSettings::*>;

struct SettingRow {
    std::string_view name;
    SettingMember member;
    std::string_view unit; // "m/s^2"; empty for plain numbers
    double min, max;       // each number's range, both ends included
    SettingGroup group;
    std::string_view reason; // what it is, and why that default
};

inline constexpr auto setting_rows = std::to_array<SettingRow>({
    {"gravity", &StepSettings::gravity, "m/s^2", -1e9, 1e9, SettingGroup::world,
     "The acceleration of every free dynamic body."},
    {"dt", &StepSettings::dt, "s", 1e-9, 1, SettingGroup::world,
     "Time that one step takes in the world."},
    {"substeps", &StepSettings::substeps, "", 1, 10000, SettingGroup::step,
     "Into how many parts a step is cut; collision is found once a step."},
    {"max_substeps", &StepSettings::max_substeps, "", 1, 10000, SettingGroup::chosen,
     "Above substeps: bodies that act on each other take as many substeps, from substeps to these, "
     "as their loads ask for; else all take substeps."},
    {"substep_tolerance", &StepSettings::substep_tolerance, "", 1e-9, 1, SettingGroup::chosen,
     "How deep a resting contact may be, as a share of the bodies' least width, and how far a "
     "joint may drift, as a share of its arms: the depth falls with the square of the substeps."},
    {"substep_budget", &StepSettings::substep_budget, "", 0, 65536, SettingGroup::chosen,
     "How much work bodies may cost together, in contacts and joints times substeps, before they "
     "get fewer substeps than they ask for: what is small is made true, what is large stays "
     "fast. A blow may cost sixteen times as much."},
    {"sleep_after", &StepSettings::sleep_after, "s", 0, 1e9, SettingGroup::sleep,
     "Bodies that act on each other and have been at rest for so long sleep, and cost nothing, "
     "until something touches them or they are changed; 0: never."},
    {"iterations", &StepSettings::iterations, "", 1, 10000, SettingGroup::constraints,
     "Passes over all constraints in each substep; soft_step makes one more over few contacts that "
     "move slowly and do not rest yet, and more after a blow."},
    {"speculative_distance", &StepSettings::speculative_distance, "m", 0, 1e9,
     SettingGroup::speculative,
     "Contacts closer than this are made before they touch, so that nothing falls into its "
     "neighbour within a step; no more than a fifth of the smaller body's width. Bodies that "
     "approach each other get their relative motion on top."},
    {"kept_travel", &StepSettings::kept_travel, "m", 0, 1e9, SettingGroup::kept,
     "Contacts of several points are kept as they were found until the surfaces have moved so far "
     "against each other, and no more than a twentieth of the smaller body's width; 0: found again "
     "in each step. Whole faces that get fewer substeps than they ask for stay for all of that "
     "twentieth while they move slowly against each other. Well below speculative_distance, so "
     "that no corner that was left out comes to touch."},
    {"penetration_slop", &StepSettings::penetration_slop, "m", 0, 1e9, SettingGroup::baumgarte,
     "Penetration that is left alone, so that contacts persist."},
    {"baumgarte", &StepSettings::baumgarte, "", 0, 1, SettingGroup::baumgarte,
     "Fraction of the penetration, or of a joint's drift, that is removed in a substep (Baumgarte "
     "1972); of drift, that sequential_impulses and nncg remove in 1/60 s where substeps are "
     "shorter."},
    {"split_impulse", &StepSettings::split_impulse, "", 0, 2, SettingGroup::split,
     "What is corrected by pseudo velocities, which are then forgotten (split impulse), not "
     "through the velocities: 0 nothing, and stacks rock; 1 contacts; 2 joints too, and no "
     "chain gains energy, but what swings loses more."},
    {"contact_frequency_ratio", &StepSettings::contact_frequency_ratio, "", 1e-6, 1000,
     SettingGroup::soft,
     "Natural frequency of a soft contact as a fraction of the substep rate: above 1/4 the spring "
     "is under-sampled, 1/8 lets it settle between neighbours; soft_step doubles it against what "
     "does not move (Catto 2024, Solver2D)."},
    {"contact_damping_ratio", &StepSettings::contact_damping_ratio, "", 0, 1e6, SettingGroup::soft,
     "Damping of a soft contact; 1 is critical, and what soft_step takes: with more a pyramid "
     "rocks for ever."},
    {"joint_frequency_ratio", &StepSettings::joint_frequency_ratio, "", 1e-6, 1000,
     SettingGroup::soft,
     "Natural frequency of a soft joint as a fraction of the substep rate: stiffer keeps a "
     "pendulum truer, and tears a chain of ten with a hundredfold weight at its end apart at four "
     "substeps; 0.2 with a damping of 5 is the stiffest that holds both."},
    {"joint_damping_ratio", &StepSettings::joint_damping_ratio, "", 0, 1e6, SettingGroup::soft,
     "Damping of a soft joint; 1 is critical."},
    {"push_velocity", &StepSettings::push_velocity, "m/s", 0, 1e9, SettingGroup::push,
     "The fastest that overlapping bodies are pushed apart."},
    {"restitution_threshold", &StepSettings::restitution_threshold, "m/s", 0, 1e9,
     SettingGroup::threshold, "Slower impacts do not bounce, so that bodies come to rest."},
    {"impact_lookahead", &StepSettings::impact_lookahead, "substeps", 0, 1000,
     SettingGroup::impacts,
     "An impact counts when it would happen within so many substeps: a hair less than one, and the "
     "solver would stop the body before it bounces; a little early does no harm, as the rebound "
     "accounts for the gap."},
    {"impact_sweeps", &StepSettings::impact_sweeps, "", 0, 10000, SettingGroup::impacts,
     "How often an impact may be propagated from contact to contact within one substep; 0: nothing "
     "bounces."},
    {"impact_passes", &StepSettings::impact_passes, "", 1, 10000, SettingGroup::impacts,
     "Gauss-Seidel passes by which points that are struck together share an impact; four corners "
     "of a box agree to float precision after about 16."},
    {"gyroscopic_iterations", &StepSettings::gyroscopic_iterations, "", 0, 100,
     SettingGroup::gyroscopic,
     "Newton steps for the implicit gyroscopic term; three reach rounding up to a third of a "
     "radian a substep."},
    {"penalty_start", &StepSettings::penalty_start, "", 1e-6, 1e6, SettingGroup::penalty,
     "The least stiffness of a contact or joint, as a share of the mass that it moves over the "
     "square of the substep: with 1 a pass takes back half of an error."},
    {"penalty_growth", &StepSettings::penalty_growth, "1/m", 0, 1e9, SettingGroup::penalty,
     "How much stiffer, in the same unit, a pass makes what is off by a metre or a radian: beta of "
     "Giles, Diaz and Yuksel 2025."},
    {"penalty_limit", &StepSettings::penalty_limit, "", 1e-6, 1e9, SettingGroup::penalty,
     "The greatest stiffness, in the same unit."},
    {"penalty_kept", &StepSettings::penalty_kept, "", 0, 1, SettingGroup::penalty,
     "The share of stiffness and load that is kept from substep to substep: their gamma."},
    {"error_kept", &StepSettings::error_kept, "", 0, 1, SettingGroup::penalty,
     "The share of an overlap, or of a joint's drift, that a substep leaves as it found it: their "
     "alpha, of which the load, too, is kept no more."},
});

namespace settings_detail {

struct AnyMember {
    template <typename Type> operator Type() const; // NOLINT(google-explicit-constructor)
};
template <typename Settings, typename... Members> consteval std::size_t member_count() {
    if constexpr (requires { Settings{Members{}..., AnyMember{}}; })
        return member_count<Settings, Members..., AnyMember>();
    else
        return sizeof...(Members);
}

} // namespace settings_detail

static_assert(settings_detail::member_count<StepSettings>() == setting_rows.size(),
              "each member of StepSettings has a row in setting_rows");

// One number of a setting: a vector has three.
struct SettingNumber {
    std::size_t row = 0; // of setting_rows
    int component = 0;   // 0 to 2; always 0 except for vectors

    const SettingRow &setting() const { return setting_rows[row]; }
    auto operator<=>(const SettingNumber &) const = default;
};

// All numbers, in table order.
std::span<const SettingNumber> setting_numbers();

// "dt", "gravity.y"
std::string setting_name(SettingNumber number);

double setting_value(const StepSettings &settings, SettingNumber number);

// `value` must be in range, and whole for a whole-number setting.
void set_setting(StepSettings &settings, SettingNumber number, double value);

bool is_whole(const SettingRow &row);
bool is_vector(const SettingRow &row);

// Null if no setting has that name.
const SettingRow *find_setting(std::string_view name);

// "a whole number from 1 to 10000", "a number from 1e-9 to 1 s"; for a vector, of each component.
std::string range_text(const SettingRow &row);

// Empty if the value is allowed; else "dt must be a number from 1e-9 to 1 s, got 2".
std::string why_refused(SettingNumber number, double value);

// Throws CheckFailure with the text of why_refused if a setting is out of range.
void check_settings(const StepSettings &settings);

void hash_settings(StateHash &hash, const StepSettings &settings);

} // namespace plumb
