// What a joint asks of two bodies, as rows that every constrained method can run: each row is a
// gradient (axis and lever arms), an error, bounds, and softness. No method knows a joint's type.
#pragma once

#include "engine/dynamics/joints/joint.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// point: three rows that hold anchor b on anchor a, along the world's axes. linear: rows along
// `axes` between the same places. angular: rows about `axes`.
enum class RowKind { point, linear, angular };

// What impulses the rows may have. equal: any. at_least, at_most: the error may be positive
// (negative) and then nothing pushes; otherwise only pushes up (down). motor: any up to max_force
// in each row. pull: up to max_force in length.
enum class RowBounds { equal, at_least, at_most, motor, pull };

// One to three rows that are solved at once.
struct RowBlock {
    RowKind kind = RowKind::point;
    RowBounds bounds = RowBounds::equal;
    int count = 3;
    std::size_t first_memory = 0; // of its rows among JointMemory::impulses

    std::array<Vec3, 3> axes{}; // unit, world; linear and angular rows
    Vec3 r_a{Real(0)};          // world, from the centres of mass to where the rows act
    Vec3 r_b{Real(0)};
    Vec3 error{Real(0)};      // of each row, at the present poses (m or rad)
    Real speed = Real(0);     // motor: wanted (m/s or rad/s)
    Real max_force = Real(0); // N or N m
    Real frequency = Real(0); // Hz; 0: rigid
    Real damping_ratio = Real(1);
    // Of a row along the line between the anchors: their distance, about which they swing (m).
    Real swing_length = Real(0);
    // The axes turn with a, so what slides along a sees a Coriolis term.
    bool turns_with_a = false;
};

// Where the blocks of a joint are written: new ones, or those of the same joint at other poses.
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

// Appends them.
class NewRows final : public RowWriter {
  public:
    explicit NewRows(std::vector<RowBlock> &blocks) : blocks_(blocks) {}

  private:
    RowBlock &next() override { return blocks_.emplace_back(); }
    std::vector<RowBlock> &blocks_;
};

// A joint at the present poses of its bodies (the world's is the identity): always the same blocks
// in the same order, of which the same members are written.
void emit_rows(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows);
void emit_rows(const Grab &grab, const Motion &world, const Motion &body, RowWriter &rows);

// How far b has come along or about what the joint leaves free, against a.
struct JointPlace {
    Real position = Real(0); // a hinge's angle (rad, -pi..pi), a slider's place (m), the distance
                             // of a distance joint's anchors (m); 0 for the others
    Real speed = Real(0);    // its rate
};
JointPlace place_of(const Joint &joint, const Motion &a, const Motion &b);

// Those of one type: one file each in joints/kinds/.
#define PLUMB_JOINT_FUNCTIONS(name)                                                                \
    void emit_##name(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows);       \
    JointPlace place_of_##name(const Joint &joint, const Motion &a, const Motion &b);
PLUMB_JOINT_TYPES(PLUMB_JOINT_FUNCTIONS)
#undef PLUMB_JOINT_FUNCTIONS

// The parts that several joints are made of.
//
// The anchors at one point: three rows.
void emit_point(const Joint &joint, const Motion &a, const Motion &b, std::size_t first_memory,
                RowWriter &rows);
// No turn of frame b against frame a: three rows about the axes of frame a.
void emit_same_turn(const Joint &joint, const Motion &a, const Motion &b, std::size_t first_memory,
                    RowWriter &rows);
// Limits and motor of one degree of freedom, whose row is `row` and whose place (rad or m) is
// `place`: two rows and one, as far as the joint has them.
void emit_limits_and_motor(const Joint &joint, const RowBlock &row, Real place,
                           std::size_t first_memory, RowWriter &rows);

// World axes of a joint's frames.
Mat3 frame_a(const Joint &joint, const Motion &a);
Mat3 frame_b(const Joint &joint, const Motion &b);
// The turn from frame a to frame b, in frame a.
Quat relative_turn(const Joint &joint, const Motion &a, const Motion &b);
// The velocity of anchor b against a's material at the same place (m/s, world).
Vec3 anchor_velocity(const Joint &joint, const Motion &a, const Motion &b);

// How far a joint's own rows, limits included, are from holding: the length of the errors of those
// along lines and of those about axes.
struct JointError {
    Real linear = Real(0); // m
    Real angular =
        Real(0); // rad; of a hinge's axes the sine, of frames twice that of half the turn
};
JointError joint_error(const Joint &joint, const Motion &a, const Motion &b);

} // namespace plumb::inline PLUMB_PRECISION
