// The world: bodies, joints and contacts, and the step that advances them.
#pragma once

#include "engine/core/hash.h"
#include "engine/core/task_pool.h"
#include "engine/dynamics/measures.h"
#include "engine/dynamics/method.h"
#include "engine/dynamics/step_report.h"

#include <optional>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Which body a ray meets first, and where.
struct WorldHit {
    BodyId body;
    RayHit hit;
};

// A copy of a World is a complete save: it continues with the same bits, at any thread count.
// What follows depends only on the poses, velocities, remembered impulses and settings, never on
// the way that led there.
class World {
  public:
    // A method unknown to the registry, or settings out of range, fail a check.
    World(std::string_view method, const StepSettings &settings);

    void set_method(std::string_view method);
    void set_settings(const StepSettings &settings);
    const Method &method() const { return *method_; }
    const StepSettings &settings() const { return settings_; }

    // Fails a check on NaN, on a mass that is not positive, on a dynamic half-space, on a dynamic
    // body without extent (a moment of inertia of 0).
    BodyId add_body(const BodyDef &def);
    // Its contacts and joints go with it. An id no longer alive fails a check.
    void remove_body(BodyId id);
    bool is_alive(BodyId id) const;

    // Between two bodies that are not dynamic it does nothing.
    JointId add_joint(const JointDef &def);
    void remove_joint(JointId id);
    bool is_alive(JointId id) const;

    // All slots, holes included (Body::alive, Joint::alive). Index i of each belongs together.
    const std::vector<Body> &bodies() const { return bodies_; }
    const std::vector<Motion> &motions() const { return motions_; }
    const std::vector<Joint> &joints() const { return joints_; }
    const std::vector<Contact> &contacts() const {
        return contacts_;
    } // of the last step, by (a, b)
    BodyId body_id(std::uint32_t index) const { return {index, bodies_[index].generation}; }

    // Sets pose and velocity of a body, as a tool or a test does.
    void set_motion(BodyId id, const Transform &pose, const Vec3 &velocity,
                    const Vec3 &angular_velocity);
    // Changes a dynamic body's velocity at once: `impulse` in N s at a world point. Others ignore
    // it.
    void apply_impulse(BodyId id, const Vec3 &impulse, const Vec3 &point);
    // Puts the solver's memory of a contact back, for a world that continues a saved one. Points
    // are known by feature; a contact that the next step does not find again is forgotten.
    void remember_contact(BodyId a, BodyId b, std::span<const std::uint32_t> features,
                          std::span<const Vec3> impulses);

    // Advances by settings().dt. `tasks` may be null: one thread. Same bits for any thread count.
    void step(TaskPool *tasks);
    const StepReport &report() const { return report_; }
    std::uint64_t step_count() const { return step_count_; }
    // For a world that continues a saved one; all its steps count as of the present dt.
    void set_step_count(std::uint64_t count);
    // Simulated time (s). A product, not a sum, of each dt that was set: step k is where it should
    // be.
    double time() const {
        return time_before_ + static_cast<double>(step_count_ - steps_before_) * settings_.dt;
    }

    // The nearest body; of two at the same t, the one with the lower index.
    std::optional<WorldHit> raycast(const Ray &ray) const;

    Measures measure() const;
    // Joint error at the present poses (m).
    Real joint_drift(const Joint &joint) const;
    Vec3 anchor_a(const Joint &joint) const; // world
    Vec3 anchor_b(const Joint &joint) const;

    // Of all that decides the future as long as no body is added. Holes do not count: a world saved
    // and loaded has the same. (A new body fills a hole, and so comes earlier in the solver's
    // order.)
    std::uint64_t hash() const;

  private:
    void find_pairs();
    void collide(TaskPool *tasks);
    void advance();
    void finish();

    bool needs_contacts() const;
    Aabb swept_bounds(std::uint32_t body) const;
    double energy_of(const Body &body, const Motion &motion) const;

    const Method *method_ = nullptr;
    StepSettings settings_;
    std::vector<Body> bodies_;
    std::vector<Motion> motions_;
    std::vector<std::uint32_t> free_bodies_;
    std::vector<Joint> joints_;
    std::vector<std::uint32_t> free_joints_;
    std::vector<std::uint64_t> joined_; // sorted pair keys that joints keep from colliding
    DynamicTree tree_;
    std::vector<std::uint32_t> half_spaces_;
    std::vector<std::uint64_t> fat_pairs_; // sorted keys of bodies whose fat boxes touch
    std::vector<Contact> contacts_;        // sorted by key
    std::uint64_t step_count_ = 0;
    double time_before_ = 0; // s, until dt was last changed
    std::uint64_t steps_before_ = 0;
    StepReport report_;

    // Scratch of one step, kept for its memory.
    std::vector<Shape> placed_;
    std::vector<Aabb> swept_;
    std::vector<std::uint8_t> moved_;
    std::vector<std::uint64_t> candidates_;
};

} // namespace plumb::inline PLUMB_PRECISION
