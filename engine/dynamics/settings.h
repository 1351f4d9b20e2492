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
    int substeps = 4; // methods override this and others (MethodInfo::defaults)
    int max_substeps = 1;
    double sleep_after = 0;
    int iterations = 1;
    double substep_tolerance = 2e-4;
    int substep_budget = 8192;
    double speculative_distance = 0.02;
    double kept_travel = 0.005;
    double penetration_slop = 0.0005;
    double baumgarte = 0.2;
    int split_impulse = 1;
    double baumgarte_time = 1.0 / 60.0;
    int foresee_turns = 1;
    int alternate_points = 1;
    int closed_form_flight = 1;
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
    additions,   // what sequential impulses as published lack
    order,       // in which a contact's points are solved
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
     "Gravitational acceleration of dynamic bodies and particles."},
    {"dt", &StepSettings::dt, "s", 1e-9, 1, SettingGroup::world, "Simulated time per step."},
    {"substeps", &StepSettings::substeps, "", 1, 10000, SettingGroup::step,
     "Substeps per step; collision detection runs once per step."},
    {"max_substeps", &StepSettings::max_substeps, "", 1, 10000, SettingGroup::chosen,
     "If above substeps, each island takes as many as its loads need, from substeps up to this; "
     "otherwise all take substeps."},
    {"substep_tolerance", &StepSettings::substep_tolerance, "", 1e-9, 1, SettingGroup::chosen,
     "Allowed penetration of a resting contact, as a fraction of the bodies' smallest width, and "
     "allowed joint drift, as a fraction of the lever arms; both fall with the square of the "
     "substeps."},
    {"substep_budget", &StepSettings::substep_budget, "", 0, 65536, SettingGroup::chosen,
     "Work that all islands together may cost, in contacts and joints times substeps, before they "
     "get fewer substeps than they need: small islands stay accurate, large ones fast. An impact "
     "may cost sixteen times as much."},
    {"sleep_after", &StepSettings::sleep_after, "s", 0, 1e9, SettingGroup::sleep,
     "Islands at rest for this long fall asleep and cost nothing until something touches or "
     "changes them; 0: never."},
    {"iterations", &StepSettings::iterations, "", 1, 10000, SettingGroup::constraints,
     "Passes over all constraints per substep; soft_step adds one for small, slow islands not yet "
     "at rest, and more after an impact."},
    {"speculative_distance", &StepSettings::speculative_distance, "m", 0, 1e9,
     SettingGroup::speculative,
     "Contacts are created this far before bodies touch, so that nothing sinks into its neighbour "
     "within a step; at most a fifth of the smaller body's width. Relative motion during the step "
     "is added."},
    {"kept_travel", &StepSettings::kept_travel, "m", 0, 1e9, SettingGroup::kept,
     "Manifolds of two or more points are reused until the surfaces have moved this far relative "
     "to each other, at most a twentieth of the smaller body's width; 0: recomputed every step. "
     "Full faces that get fewer substeps than they need are kept for the whole twentieth while "
     "they move slowly. Keep it well below speculative_distance, so that no omitted corner comes "
     "to touch."},
    {"penetration_slop", &StepSettings::penetration_slop, "m", 0, 1e9, SettingGroup::baumgarte,
     "Penetration left uncorrected, so that contacts persist."},
    {"baumgarte", &StepSettings::baumgarte, "", 0, 1, SettingGroup::baumgarte,
     "Fraction of penetration or joint drift removed per substep (Baumgarte 1972)."},
    {"split_impulse", &StepSettings::split_impulse, "", 0, 2, SettingGroup::split,
     "What is corrected by pseudo velocities that are then discarded (split impulse), not through "
     "the velocities: 0 nothing, and stacks rock; 1 contacts; 2 joints too, and no chain gains "
     "energy, but swinging bodies lose more."},
    {"baumgarte_time", &StepSettings::baumgarte_time, "s", 0, 1e9, SettingGroup::additions,
     "Where substeps are shorter than this, joints lose that fraction of drift per this time, "
     "unless split_impulse is 2; 0: always per substep, and chains gain more energy the shorter "
     "the step."},
    {"foresee_turns", &StepSettings::foresee_turns, "", 0, 1, SettingGroup::additions,
     "1: how far joints drift because bodies turn within the substep is removed beforehand, to "
     "second order, unless split_impulse is 2; 0: drift grows until its bias balances it."},
    {"alternate_points", &StepSettings::alternate_points, "", 0, 1, SettingGroup::order,
     "1: every other pass takes a contact's points from last to first; 0: none does, and stacks "
     "sway, as each point leaves too much to the last."},
    {"closed_form_flight", &StepSettings::closed_form_flight, "", 0, 1, SettingGroup::additions,
     "1: what nothing touches flies along its parabola and turns by its mean spin; 0: by "
     "semi-implicit Euler, g h t / 2 too low after a time t with substeps of h."},
    {"contact_frequency_ratio", &StepSettings::contact_frequency_ratio, "", 1e-6, 1000,
     SettingGroup::soft,
     "Natural frequency of soft contacts as a fraction of the substep rate: above 1/4 the spring "
     "is under-sampled, 1/8 lets it settle between neighbours. Doubled against immovable bodies "
     "(Catto 2024, Solver2D)."},
    {"contact_damping_ratio", &StepSettings::contact_damping_ratio, "", 0, 1e6, SettingGroup::soft,
     "Damping ratio of soft contacts; 1 is critical, and soft_step's default: with more, pyramids "
     "rock forever."},
    {"joint_frequency_ratio", &StepSettings::joint_frequency_ratio, "", 1e-6, 1000,
     SettingGroup::soft,
     "Natural frequency of soft joints as a fraction of the substep rate. Stiffer joints make a "
     "pendulum more accurate, but at four substeps tear apart a chain of ten with a hundredfold "
     "weight at its end; in soft_step, 0.2 with a damping ratio of 5 is the stiffest that handles "
     "both. TGS Soft has its own."},
    {"joint_damping_ratio", &StepSettings::joint_damping_ratio, "", 0, 1e6, SettingGroup::soft,
     "Damping ratio of soft joints; 1 is critical."},
    {"push_velocity", &StepSettings::push_velocity, "m/s", 0, 1e9, SettingGroup::push,
     "Maximum speed at which overlapping bodies are pushed apart; in soft_step, also at which "
     "joints are pulled together."},
    {"restitution_threshold", &StepSettings::restitution_threshold, "m/s", 0, 1e9,
     SettingGroup::threshold,
     "Impacts slower than this do not bounce, so that bodies come to rest."},
    {"impact_lookahead", &StepSettings::impact_lookahead, "substeps", 0, 1000,
     SettingGroup::impacts,
     "Impacts due within this many substeps are resolved now. Below one, the solver would stop a "
     "body before it bounces; slightly early does no harm, as the rebound accounts for the gap."},
    {"impact_sweeps", &StepSettings::impact_sweeps, "", 0, 10000, SettingGroup::impacts,
     "Maximum number of sweeps that propagate impacts from contact to contact in a substep; 0: "
     "soft_step does not bounce, the others bounce once a step, each contact by itself."},
    {"impact_passes", &StepSettings::impact_passes, "", 1, 10000, SettingGroup::impacts,
     "Gauss-Seidel passes over the points that share an impact; four corners of a box converge to "
     "float precision in about 16."},
    {"gyroscopic_iterations", &StepSettings::gyroscopic_iterations, "", 0, 100,
     SettingGroup::gyroscopic,
     "Newton steps for the implicit gyroscopic term; three reach rounding error up to a third of a "
     "radian per substep."},
    {"penalty_start", &StepSettings::penalty_start, "", 1e-6, 1e6, SettingGroup::penalty,
     "Minimum stiffness of a contact or joint, in units of its effective mass over the substep "
     "squared: at 1, a pass removes half of an error."},
    {"penalty_growth", &StepSettings::penalty_growth, "1/m", 0, 1e9, SettingGroup::penalty,
     "Stiffness, in the same unit, that a pass adds per metre or radian of error: beta of Giles, "
     "Diaz and Yuksel 2025."},
    {"penalty_limit", &StepSettings::penalty_limit, "", 1e-6, 1e9, SettingGroup::penalty,
     "Maximum stiffness, in the same unit."},
    {"penalty_kept", &StepSettings::penalty_kept, "", 0, 1, SettingGroup::penalty,
     "Fraction of stiffness and load kept from substep to substep: gamma of Giles et al. 2025."},
    {"error_kept", &StepSettings::error_kept, "", 0, 1, SettingGroup::penalty,
     "Fraction of the initial penetration or joint drift that a substep leaves uncorrected; it "
     "also scales the kept load: alpha of Giles et al. 2025."},
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
