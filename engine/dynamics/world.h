// The world: a model, a state, and the step that advances it.
#pragma once

#include "engine/core/hash.h"
#include "engine/core/task_pool.h"
#include "engine/dynamics/measures.h"
#include "engine/dynamics/method.h"
#include "engine/dynamics/saved_world.h"
#include "engine/dynamics/scratch.h"

#include <memory>
#include <optional>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// The first body that a ray hits, which of its colliders, and where.
struct WorldHit {
    BodyId body;
    std::uint16_t child = 0;
    RayHit hit;
};

// A manifold and the poses it was found at: the present ones, or those at which the bodies will
// touch.
struct FoundManifold {
    Manifold manifold;
    Motion a;
    Motion b;
    FoundAt found_at = FoundAt::start;
    bool is_turning = false;
    Real hollow = Real(0); // Contact::hollow
    // The feature of the point that runs round the body's rim.
    std::optional<std::uint32_t> on_rim_a = std::nullopt;
    std::optional<std::uint32_t> on_rim_b = std::nullopt;
};

// Three parts: the model (what only an edit changes), the state (everything that survives a step),
// and scratch, which may be discarded between any two steps. The future depends only on the model,
// the state, the method and the settings, never on how the world got there. Not thread-safe, not
// even for reading: const functions keep what they find in scratch.
class World {
  public:
    // Fails a check on a method unknown to the registry, and on settings out of range.
    World(std::string_view method, const StepSettings &settings);

    void set_method(std::string_view method);
    void set_settings(const StepSettings &settings);
    const Method &method() const { return *method_; }
    const StepSettings &settings() const { return settings_; }

    // Fails a check on NaN, on a body without colliders, on a mass that is not positive, on a
    // dynamic half-space or surface, on a dynamic body without extent (a moment of inertia of 0).
    BodyId add_body(const BodyDef &def);
    // Its contacts and joints go with it, and its springs tear. An id no longer alive fails a
    // check.
    void remove_body(BodyId id);
    bool is_alive(BodyId id) const;

    // A joint between two bodies that are not dynamic does nothing.
    JointId add_joint(const JointDef &def);
    void remove_joint(JointId id);
    JointId joint_id(std::uint32_t index) const { return {index, joints()[index].generation}; }
    bool is_alive(JointId id) const;

    // Particles and springs are never removed. Both functions return the index. They fail a check
    // on a mass or radius that is not positive, a NaN, a negative stiffness, and an end that does
    // not exist.
    std::uint32_t add_particle(const ParticleDef &def);
    std::uint32_t add_spring(const SpringDef &def);
    // Never removed either. Numbers that are not finite fail a check; a parameter below 0 repels.
    void add_attractor(const Attractor &attractor);

    const Model &model() const { return *model_; }
    const State &state() const { return state_; }
    // All slots, holes included (Body::alive, Joint::alive). bodies()[i] and motions()[i] belong
    // together.
    const std::vector<Body> &bodies() const { return model_->bodies; }
    const std::vector<Motion> &motions() const { return state_.motions; }
    const std::vector<Joint> &joints() const { return model_->joints; }
    BodyId body_id(std::uint32_t index) const { return {index, bodies()[index].generation}; }

    // Contacts of the last step, ascending by key; found again at the present poses if the world
    // was restored or edited since, or if any body is asleep.
    const std::vector<Contact> &contacts() const;
    const std::vector<Impact> &impacts() const { return scratch_.impacts; } // of the last step

    // The pose of the body's own frame.
    Transform pose_of(std::uint32_t body) const;
    // Sets a body's pose and velocity, as a tool or a test does. A static body has no velocity.
    void set_motion(BodyId id, const Transform &pose, const Vec3 &velocity,
                    const Vec3 &angular_velocity);
    // Changes a dynamic body's velocity immediately: `impulse` in N s at a world point. Other
    // bodies ignore it.
    void apply_impulse(BodyId id, const Vec3 &impulse, const Vec3 &point);
    // Holds a point of a dynamic body (in its own frame) at the target until release or until the
    // body is removed; a second grab replaces the first. Other bodies ignore it.
    void grab(BodyId id, const Vec3 &point_local, const Vec3 &target, Real max_force,
              const GrabSpring &spring = {});
    void move_grab(const Vec3 &target); // does nothing if nothing is held
    void release();
    // Moves a particle, as a tool or a test does. A pinned particle stays at rest there.
    void set_particle(std::uint32_t index, const Vec3 &position, const Vec3 &velocity);
    // Like grab, for a particle. A pinned particle is not held.
    void grab_particle(std::uint32_t index, const Vec3 &target, Real max_force,
                       const GrabSpring &pull = {});
    // Restores the solver's memory of a contact, for a world that continues a saved one. Points are
    // matched by feature id; a contact that the next step does not find again is forgotten.
    void remember_contact(const ContactKey &key, const ContactOrigin &origin,
                          std::span<const PointMemory> points,
                          std::span<const PointPenalty> penalties = {});

    // Advances by settings().dt. `tasks` may be null: one thread. Same bits for any thread count. A
    // step that throws leaves the state unchanged. `times`, if not null, gets the phases' times.
    void step(TaskPool *tasks, StepTimes *times = nullptr);
    const StepReport &report() const { return report_; }
    std::uint64_t step_count() const { return state_.clock.step_count; }
    // For a world that continues a saved one, once its bodies and joints are back.
    void set_pace(BodyId id, const Pace &pace);
    // For a world that continues a saved one. Fails a check unless dt was last changed at a time
    // that is finite and not negative, and after no more steps than were taken.
    void set_clock(const StateClock &clock);
    // For a world that continues a saved one: resumes a grab, with what the solver remembers of it.
    // A body or particle that cannot be held is not held, as with `grab`.
    void hold(const Grab &grab);
    // Simulated time (s), without the rounding of a running sum.
    double time() const {
        const StateClock &clock = state_.clock;
        return clock.time_before +
               static_cast<double>(clock.step_count - clock.steps_before) * settings_.dt;
    }

    // Copies the state, shares the model, and shares with `before` (may be null) each part of the
    // state that has not changed since. `into` reuses its memory, so a full ring of saves allocates
    // nothing as long as everything it saves moves.
    void save(SavedWorld &into, const SavedWorld *before = nullptr) const;
    void restore(const SavedWorld &saved);

    // The nearest body hit; at equal t, the one with the lower index. Rays pass through sensors.
    std::optional<WorldHit> raycast(const Ray &ray) const;

    Measures measure() const;
    double energy() const; // kinetic and potential, J
    // A joint's linear and angular error, and the length of both together, counting 1 rad as 1 m.
    JointError joint_errors(std::uint32_t joint) const;
    Real joint_error(std::uint32_t joint) const;
    // A joint's load in the last substep: force at the anchor and torque, on b, in world axes.
    struct JointLoad {
        Vec3 force{Real(0)};  // N
        Vec3 torque{Real(0)}; // N m
    };
    JointLoad joint_load(std::uint32_t joint) const;
    // The number of substeps that a body's island took in the last step.
    int substeps_of(std::uint32_t body) const;
    // Which of two bodies has their contact or joint in its island; either may be Joint::world.
    std::uint32_t island_body(std::uint32_t a, std::uint32_t b) const;
    Vec3 anchor_a(const Joint &joint) const; // world
    Vec3 anchor_b(const Joint &joint) const;
    const Motion &joint_motion(std::uint32_t body) const; // the world's is the identity

    // Hash of everything that decides the future as long as no body is added. Holes do not count,
    // so a world has the same hash after a save and load. (A new body fills a hole, and so comes
    // earlier in the solver's order.)
    std::uint64_t hash() const;

  private:
    // The phases of a step; const ones work on scratch alone.
    bool is_each_alone() const;
    void step_each_alone(StepTimes *times);
    void step_together(StepTimes *times);
    void find_contacts(StepTimes *times = nullptr);
    void find_pairs() const;
    void collide() const;
    void load_body(std::size_t i);
    void load_motions();
    void load_bodies();
    bool is_pressed(const ContactKey &key) const;
    void begin_contacts();
    void note_struck();
    void record_landings();
    void advance();
    void advance_groups();
    std::uint32_t remembered_points(const Contact &contact) const;
    void remember(const Contact &contact, ContactMemory &memory);
    void recall_impulses();
    void gather_memory();
    void load_penalties();
    void gather_penalties();
    void remember_penalties(std::span<const PointPenalty> penalties, std::size_t point_count);
    void remember_penalty(std::uint32_t joint, const JointPenalty &penalty);
    void finish_motions();
    void finish();

    // Islands and their substeps (islands.cpp).
    bool chooses_substeps() const;
    bool moves(std::uint32_t body) const;
    bool holds(std::uint32_t joint) const;
    void find_islands();
    void find_braced();
    void gather_needs();
    void guess_needs();
    int chosen_substeps(const Islands::Needs &needs, int budget) const;
    void share_budget();
    void settle_slow_islands();
    void settle_joined_islands();
    void choose_substeps();
    void group_freely();
    void group_islands();
    void note_contact_needs(const IslandGroup &group);
    void note_joint_needs(const IslandGroup &group);
    void note_turn_needs(const IslandGroup &group);
    void note_let_go(const IslandGroup &group);
    bool is_solved_together(std::uint32_t body) const;
    void note_needs(const IslandGroup &group);
    int finer_budget() const;
    bool was_any_let_go() const;
    bool went_too_coarsely() const;

    // Sleep (sleep.cpp).
    bool sleeps() const;
    void note_still(bool asleep) const;
    void find_sleeping_islands(const std::vector<Pace> &paces) const;
    void wake_marked(std::vector<Pace> &paces) const;
    bool wake_touched(const std::vector<Contact> &contacts);
    void wake(std::uint32_t body);
    void wake_all();
    bool is_at_rest(std::uint32_t index) const;
    bool is_giving_way(const Spring &spring) const;
    void mark_giving_way();
    std::uint16_t steps_to_sleep() const;
    void fall_asleep();

    // Particles and springs (world_particles.cpp, find_particle_contacts.cpp).
    bool moves_particles() const;
    bool needs_particle_contacts() const;
    void find_particle_contacts() const;
    void collide_particle(std::uint32_t index, std::size_t part,
                          std::vector<ParticleContact> &out) const;
    void collide_particle(std::uint32_t index, std::uint32_t collider, std::size_t part,
                          std::vector<ParticleContact> &out) const;
    void add_particle_contact(std::uint32_t particle, std::uint32_t collider,
                              const Manifold &manifold, const Motion &at,
                              std::vector<ParticleContact> &out) const;
    bool is_particle_at_rest(const ParticleMotion &motion) const;
    bool is_spring_end_still(const SpringEnd &end) const;
    bool mark_touched_by_particles() const;
    void load_particles();
    void join_particles();
    void gather_particle_needs();
    void gather_wedge_needs();
    double spring_rate() const;
    void tear_springs();
    void tear_springs_of(std::uint32_t body);
    void end_particles();
    void add_particles(Measures &m) const;
    double particle_energy() const;

    // The acceleration by gravity, attractors and constant force where a body or particle began the
    // step; zero for anything that forces do not move.
    Vec3 pull_on(std::uint32_t body) const;
    Vec3 pull_on_particle(std::uint32_t particle) const;

    bool is_turned(const Candidate &candidate) const;
    bool is_crowded(std::uint32_t body) const;
    bool rolls_over_the_other(const Contact &contact) const;
    Rolling rolling_of(const Contact &contact) const;
    bool tips(const Contact &contact, bool is_a) const;
    bool rides(const Contact &contact) const;
    std::optional<bool> turns_over_b(const Contact &contact) const;
    // Its rolling and the body it then turns with.
    void choose_rolling(Contact &contact) const;
    bool rolls_freely(std::uint32_t body) const;
    void follow_rim(const FoundManifold &found, Contact &contact) const;
    // Lets a contact follow the hollow that its solid slides or rolls through (hollow_contact.h).
    void follow_hollow(const Candidate &candidate, std::uint32_t triangle,
                       FoundManifold &found) const;
    bool needs_contacts() const;
    bool is_asked(std::uint32_t body) const;
    bool meets_nothing(const Collider &collider) const;
    bool place_collider(std::uint32_t i) const;
    bool place_colliders() const;
    bool may_touch(std::uint32_t i, std::uint32_t j) const;
    bool may_be_within(Real distance, std::uint32_t i, std::uint32_t j) const;
    void add_candidate(std::uint32_t i, std::uint32_t j, std::vector<Candidate> &out) const;
    void find_fat_pairs() const;
    void find_pairs_with_planes() const;
    Aabb swept_bounds(const Aabb &box, const ColliderReach &of) const;
    Real contact_margin(const Candidate &candidate) const;
    Manifold present_manifold(const Contact &contact) const;
    void collide_candidate(const Candidate &candidate, std::vector<Contact> &out,
                           std::vector<std::uint32_t> &triangles) const;
    Real acting_side(const ContactKey &key) const;
    Contact &begin_contact(const Candidate &candidate, std::uint32_t triangle,
                           std::vector<Contact> &out) const;
    bool keeps_contacts() const;
    bool gets_too_few_substeps(std::uint32_t body) const;
    // `before`: what is remembered of it, or null.
    bool keep_contact(const Candidate &candidate, const ContactMemory *before,
                      std::vector<Contact> &out) const;
    Vec3 half_turn_of(const Candidate &candidate) const;
    bool misses_corner(const Candidate &candidate, const Manifold &manifold) const;
    bool stands_on_wide_face(const Candidate &candidate, const Manifold &manifold) const;
    std::optional<Vec3> load_on(const Candidate &candidate, const Vec3 &normal,
                                const Vec3 &at) const;
    std::optional<Vec3> load_off_centre(const Candidate &candidate, const Manifold &manifold) const;
    bool stands_wider(const Candidate &candidate, const Manifold &manifold) const;
    bool rolls_off(const Candidate &candidate, const ContactOrigin &origin) const;
    void add_contact(const Candidate &candidate, std::uint32_t triangle,
                     const ContactMemory *before, const FoundManifold &found,
                     std::vector<Contact> &out) const;
    void set_anchor(Contact &contact, std::size_t k, const Motion &a, const Motion &b) const;
    // A point's separation, from its anchor (m).
    Real separation_now(const Contact &contact, std::size_t k) const;
    void note_floors() const;
    bool moves_as_one(std::uint32_t one, std::uint32_t other, Real apart) const;
    // Drops the part that the neighbours of a static or kinematic body cover (inner_edges.h).
    void drop_inner_edges(const Candidate &candidate, std::uint32_t triangle,
                          FoundManifold &found) const;
    // Contacts of bodies that do not touch yet (predicted_contact.cpp).
    const Motion &expected_motion(std::uint32_t body) const;
    Real least_half_width(const Body &body) const;
    bool find_contacts_of_deflected();
    // Bodies that no contact stopped (missed_contact.cpp).
    bool find_missed_points(bool of_solids);
    bool find_missed_points(Contact &contact) const;
    bool find_passed_points(const Candidate &candidate);
    bool add_missed(const Manifold &now, Real deep, Contact &contact) const;
    Real contact_reach(const Candidate &candidate) const;
    Real moving_width(const Candidate &candidate) const;
    // How far turning moves the body's surface at most, per radian (m).
    Real extent_of(std::uint32_t index) const;
    Real turning_reach(std::uint32_t index) const;
    Real way_of(const Candidate &candidate) const;
    void guard_middle(const Candidate &candidate, const Shape &solid_a, const Shape &solid_b,
                      FoundManifold &found) const;
    // `now`, `normal`: the manifold and its normal at the start.
    FoundManifold predicted_manifold(const Candidate &candidate, const Manifold &now) const;
    FoundManifold predicted_manifold(const Candidate &candidate, const Vec3 &normal,
                                     std::uint32_t triangle) const;

    void use(const StepSettings &settings);
    // The model for editing; copied first if saves share it.
    Model &edit();
    void add_colliders(const BodyDef &def, Body &body, std::uint32_t slot);
    void forget_contacts_of(std::uint32_t body);
    void forget_lost_loads_of(std::uint32_t body);
    void forget_places_of(const Body &body);

    const Method *method_ = nullptr;
    StepSettings settings_;
    std::shared_ptr<Model> model_;
    State state_;
    StepReport report_;
    mutable Scratch scratch_;
};

} // namespace plumb::inline PLUMB_PRECISION
