// The joint types: each one's name and keys in files, the impulses it keeps, how it is drawn. The
// reader, the writer, their errors and the reference in scenes/README.md come from this table.
#pragma once

#include "engine/scene/file/bounds.h"
#include "engine/scene/joint_desc.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace plumb {

// A joint's key in files, whose value is one member of JointDesc.
struct JointKey {
    struct Length {}; // sets both min_length and max_length
    using Member = std::variant<Length, bool JointDesc::*, double JointDesc::*,
                                std::optional<double> JointDesc::*,
                                std::optional<std::array<double, 2>> JointDesc::*>;
    std::string_view name;
    Member member;
    // "rad" and "rad/s": an angle; the key with _deg appended then takes degrees.
    std::string_view unit;
    scene_file::Bounds bounds; // in degrees for an angle
    std::string_view needs;    // a key this one is meaningless without; empty: none
    std::string_view about;
    std::string_view by_default;

    [[nodiscard]] bool is_angle() const { return unit.starts_with("rad"); }
};

struct JointTypeInfo {
    // axis: the frames' x axes are the joint's axis. whole: every axis counts.
    enum class Frames { none, axis, whole };
    // Where the anchors start. together: at one point. on_axis: on the x axis of a's frame. apart:
    // anywhere; default to the body origins.
    enum class Anchors { together, on_axis, apart };

    JointType type;
    std::string_view name;
    std::string_view about;
    std::string_view drawn;
    Anchors anchors;
    Frames frames;
    // One word for its free coordinate (JointPlace), "" if it has none, and whether that is an
    // angle (rad) rather than a length (m).
    std::string_view place;
    bool turns;
    std::vector<JointKey> keys;         // in addition to the common ones
    std::vector<std::string_view> rows; // what each impulse is of, in row order
};

const std::vector<JointKey> &common_joint_keys();
const JointTypeInfo &joint_type(JointType type);
// With the fields that its type does not read at their defaults, as a file leaves them out.
JointDesc as_read(JointDesc joint);
std::span<const JointTypeInfo *const> joint_types(); // in the order of the enumeration

// The types and keys as Markdown tables for scenes/README.md.
std::string joint_reference();

} // namespace plumb
