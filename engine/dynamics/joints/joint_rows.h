// A joint as constraint rows that every constrained method can solve: each row has a gradient (axis
// and lever arms), an error, bounds and softness. No method knows a joint's type.
#pragma once

#include "engine/dynamics/joints/joint.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// point: three rows that hold anchor b on anchor a, along the world axes. linear: rows along `axes`
// between the same points. angular: rows about `axes`.
enum class RowKind { point, linear, angular };

// Which impulses the rows may apply. equal: any. at_least (at_most): none while the error is
// positive (negative), otherwise only upwards (downwards). motor: any up to max_force in each row.
// pull: any up to max_force in length.
enum class RowBounds { equal, at_least, at_most, motor, pull };

// One to three rows that are solved together.
struct RowBlock {
    RowKind kind = RowKind::point;
    RowBounds bounds = RowBounds::equal;
    int count = 3;
    std::size_t first_memory = 0; // index of its first row in JointMemory::impulses

    std::array<Vec3, 3> axes{}; // unit, world; linear and angular rows
    Vec3 r_a{Real(0)};          // world, from the centres of mass to the points where the rows act
    Vec3 r_b{Real(0)};
    Vec3 error{Real(0)};      // of each row, at the present poses (m or rad)
    Real speed = Real(0);     // motor: target (m/s or rad/s)
    Real max_force = Real(0); // N or N m
    Real frequency = Real(0); // Hz; 0: rigid
    Real damping_ratio = Real(1);
    // Rows along the line between the anchors: the anchors' distance, the radius of the swing (m).
    Real swing_length = Real(0);
    // The axes turn with a, so motion along a is subject to a Coriolis term.
    bool turns_with_a = false;
};

// Receives a joint's blocks: new ones, or the existing ones at new poses.
class RowWriter {
  public:
    RowWriter() = default;
    virtual ~RowWriter() = default;
    RowWriter(const RowWriter &) = delete;
    RowWriter &operator=(const RowWriter &) = delete;

    RowBlock &add(RowKind kind, RowBounds bounds, int count, std::size_t first_memory) {
        RowBlock &block = next();
        block.kind = kind;
        block.bounds = bounds;
        block.count = count;
        block.first_memory = first_memory;
        return block;
    }

  private:
    virtual RowBlock &next() = 0;
};

// Appends them to a vector.
class NewRows final : public RowWriter {
  public:
    explicit NewRows(std::vector<RowBlock> &blocks) : blocks_(blocks) {}

  private:
    RowBlock &next() override { return blocks_.emplace_back(); }
    std::vector<RowBlock> &blocks_;
};

// A joint's rows at its bodies' present poses (the world's is the identity). Always emits the same
// blocks in the same order, and writes the same members.
void emit_rows(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows);
void emit_rows(const Grab &grab, const Motion &world, const Motion &body, RowWriter &rows);

// The position of b relative to a along or about the joint's free axis.
struct JointPlace {
    Real position = Real(0); // a hinge's angle (rad, -pi..pi), a slider's offset (m), the distance
                             // of a distance joint's anchors (m); 0 for the others
    Real speed = Real(0);    // its rate
};
JointPlace place_of(const Joint &joint, const Motion &a, const Motion &b);

// Per joint type: one file each in joints/kinds/.
#define PLUMB_JOINT_FUNCTIONS(name)                                                                \
    void emit_##name(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows);       \
    JointPlace place_of_##name(const Joint &joint, const Motion &a, const Motion &b);
PLUMB_JOINT_TYPES(PLUMB_JOINT_FUNCTIONS)
#undef PLUMB_JOINT_FUNCTIONS

// Parts shared by several joints.
//
// Holds the anchors together: three rows.
void emit_point(const Joint &joint, const Motion &a, const Motion &b, std::size_t first_memory,
                RowWriter &rows);
// Keeps frame b aligned with frame a: three rows about the axes of frame a.
void emit_same_turn(const Joint &joint, const Motion &a, const Motion &b, std::size_t first_memory,
                    RowWriter &rows);
// Limits and motor of one degree of freedom with row `row` and position `place` (rad or m): up to
// two rows and one.
void emit_limits_and_motor(const Joint &joint, const RowBlock &row, Real place,
                           std::size_t first_memory, RowWriter &rows);

// World axes of a joint's frames.
Mat3 frame_a(const Joint &joint, const Motion &a);
Mat3 frame_b(const Joint &joint, const Motion &b);
// The rotation from frame a to frame b, in frame a.
Quat relative_turn(const Joint &joint, const Motion &a, const Motion &b);
// The velocity of anchor b against a's material at the same place (m/s, world).
Vec3 anchor_velocity(const Joint &joint, const Motion &a, const Motion &b);

// How far a joint's own rows, limits included, are violated: the lengths of the linear and the
// angular errors.
struct JointError {
    Real linear = Real(0); // m
    Real angular =
        Real(0); // rad; hinge axes: sine of their angle; frames: twice the sine of half the turn
};
JointError joint_error(const Joint &joint, const Motion &a, const Motion &b);

} // namespace plumb::inline PLUMB_PRECISION
