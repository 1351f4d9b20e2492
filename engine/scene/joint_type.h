// The types of joints: what each is called in files, reads, remembers and looks like. The reader,
// the writer, their errors and the reference in scenes/README.md come from this table.
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

// A key of a joint in files whose value is one member of its JointDesc.
struct JointKey {
    struct Length {}; // min_length and max_length at once
    using Member = std::variant<Length, bool JointDesc::*, double JointDesc::*,
                                std::optional<double> JointDesc::*,
                                std::optional<std::array<double, 2>> JointDesc::*>;
    std::string_view name;
    Member member;
    // "rad" and "rad/s": an angle; the key with _deg at its end then takes degrees.
    std::string_view unit;
    scene_file::Bounds bounds; // of an angle: in degrees
    std::string_view needs;    // the key without which this one says nothing; empty: none
    std::string_view about;
    std::string_view by_default;

    [[nodiscard]] bool is_angle() const { return unit.starts_with("rad"); }
};

struct JointTypeInfo {
    // axis: of the frames the x axes are the joint's axis. whole: each axis counts.
    enum class Frames { none, axis, whole };
    // Where they begin. on_axis: of a's frame. apart: where none are given, at the centres.
    enum class Anchors { together, on_axis, apart };

    JointType type;
    std::string_view name;
    std::string_view about;
    std::string_view drawn;
    Anchors anchors;
    Frames frames;
    // What it leaves free, in a word, "" if it has no place (JointPlace), and whether that is an
    // angle (rad) and no length (m).
    std::string_view place;
    bool turns;
    std::vector<JointKey> keys;         // besides those that every joint has
    std::vector<std::string_view> rows; // what the impulses are of, in this order
};

const std::vector<JointKey> &common_joint_keys();
const JointTypeInfo &joint_type(JointType type);
std::span<const JointTypeInfo *const> joint_types(); // in the order of the enumeration

// As tables in Markdown: what scenes/README.md says of types and keys.
std::string joint_reference();

} // namespace plumb
