#include "engine/scene/file/text.h"
#include "engine/scene/joint_type.h"

#include <algorithm>

namespace plumb::scene_file {

namespace {

using Pair = std::optional<std::array<double, 2>>;

std::string assignment(const JointKey &key, const std::string &value) {
    return std::string(key.name) + " = " + value + "\n";
}

std::string number_text(const JointKey &key, double value) {
    return key.is_angle() ? angle(std::string(key.name), value) : assignment(key, shortest(value));
}

std::string pair_text(const JointKey &key, const std::array<double, 2> &pair) {
    const auto [lower, upper] = pair;
    if (key.is_angle())
        if (const auto from = exact_degrees(lower), to = exact_degrees(upper); from && to)
            return std::string(key.name) + "_deg = [" + shortest(*from) + ", " + shortest(*to) +
                   "]\n";
    return assignment(key, "[" + shortest(lower) + ", " + shortest(upper) + "]");
}

// A key's line; empty where omitting it means the same.
struct KeyLine {
    const JointKey &key;
    const JointDesc &joint;
    bool is_needed; // by another key that is written

    bool is_rod() const { return same_bits(joint.min_length, joint.max_length); }

    std::string operator()(JointKey::Length) const {
        return is_rod() ? number_text(key, joint.max_length) : "";
    }
    std::string operator()(bool JointDesc::*member) const {
        return joint.*member ? assignment(key, "true") : "";
    }
    std::string operator()(double JointDesc::*member) const {
        const bool is_length = member == &JointDesc::min_length || member == &JointDesc::max_length;
        const bool is_default = same_bits(joint.*member, JointDesc{}.*member);
        const bool is_said = (!is_default || is_needed) && !(is_length && is_rod());
        return is_said ? number_text(key, joint.*member) : "";
    }
    std::string operator()(std::optional<double> JointDesc::*member) const {
        return joint.*member ? number_text(key, *(joint.*member)) : "";
    }
    std::string operator()(Pair JointDesc::*member) const {
        return joint.*member ? pair_text(key, *(joint.*member)) : "";
    }
};

std::string lines_of(const std::vector<JointKey> &keys, const JointDesc &joint) {
    const auto line_of = [&](const JointKey &key, bool is_needed) {
        return std::visit(KeyLine{key, joint, is_needed}, key.member);
    };
    std::string text;
    for (const JointKey &key : keys)
        text += line_of(key, std::ranges::any_of(keys, [&](const JointKey &other) {
                            return other.needs == key.name && !line_of(other, false).empty();
                        }));
    return text;
}

} // namespace

std::string joint_text(const JointDesc &joint) {
    const JointTypeInfo &type = joint_type(joint.type);
    const auto line = [](const std::string &key, const std::string &value) {
        return key + " = " + value + "\n";
    };
    std::string text = line("name", string(joint.name)) + line("type", string(type.name)) +
                       line("body_a", string(joint.body_a.empty() ? "world" : joint.body_a)) +
                       line("body_b", string(joint.body_b.empty() ? "world" : joint.body_b)) +
                       line("anchor_a_local", array3(joint.anchor_a_local)) +
                       line("anchor_b_local", array3(joint.anchor_b_local));
    if (type.frames != JointTypeInfo::Frames::none)
        text += line("frame_a_local", rotation(joint.frame_a_local)) +
                line("frame_b_local", rotation(joint.frame_b_local));
    text += lines_of(type.keys, joint) + lines_of(common_joint_keys(), joint);
    const auto write_rows = [&](const std::string &key, std::span<const double> rows) {
        rows = rows.first(type.rows.size());
        if (std::ranges::all_of(rows, [](double value) { return same_bits(value, 0); }))
            return;
        std::string list;
        for (const double value : rows)
            list += (list.empty() ? "" : ", ") + shortest(value);
        text += line(key, "[" + list + "]");
    };
    write_rows("impulses", joint.impulses);
    write_rows("penalties", joint.penalties);
    return text;
}

} // namespace plumb::scene_file
