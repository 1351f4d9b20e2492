#include "engine/scene/joint_type.h"

#include "engine/core/check.h"

#include <algorithm>
#include <type_traits>

namespace plumb {

namespace {

using scene_file::Bounds;
using scene_file::moderate;
using scene_file::not_negative;
using scene_file::positive;

constexpr Bounds yes_or_no{0, 1, "true or false"};
constexpr Bounds half_turn{-180, 180, "an angle from -180 to 180 degrees"};

std::vector<JointKey> limits_and_motor(std::string_view unit, const Bounds &bounds,
                                       std::string_view force, std::string_view what) {
    const bool is_angle = unit == "rad";
    return {{"limits", &JointDesc::limits, unit, bounds, "", what, "none"},
            {"motor_speed", &JointDesc::motor_speed, is_angle ? "rad/s" : "m/s", moderate,
             "max_motor_force", "target speed; setting it turns the motor on", "no motor"},
            {"max_motor_force", &JointDesc::max_motor_force, force, not_negative, "",
             is_angle ? "the motor's maximum torque" : "the motor's maximum force", "0"}};
}

// Null past the last type.
const JointTypeInfo *find(JointType type) {
    using Frames = JointTypeInfo::Frames;
    using Anchors = JointTypeInfo::Anchors;
    switch (type) {
    case JointType::ball: {
        static const JointTypeInfo info{type,
                                        "ball",
                                        "holds two points together",
                                        "a dot",
                                        Anchors::together,
                                        Frames::none,
                                        "",
                                        false,
                                        {},
                                        {"x", "y", "z"}};
        return &info;
    }
    case JointType::distance: {
        static const JointTypeInfo info{
            type,
            "distance",
            "keeps two points at a fixed distance, like a rod; between a minimum and a maximum, "
            "like a rope; or, with a `frequency`, like a spring",
            "a rod, a rope that sags when slack, or a coil",
            Anchors::apart,
            Frames::none,
            "Length",
            false,
            {{"length", JointKey::Length{}, "m", positive, "", "minimum and maximum length at once",
              "the distance between the anchors at the start"},
             {"min_length", &JointDesc::min_length, "m", not_negative, "max_length",
              "the minimum distance between the anchors", "0"},
             {"max_length", &JointDesc::max_length, "m", positive, "",
              "the maximum distance between the anchors", ""}},
            {"length or maximum length", "minimum length"}};
        return &info;
    }
    case JointType::hinge: {
        static const JointTypeInfo info{
            type,
            "hinge",
            "holds two points and an axis together; the angle is b's rotation about the axis "
            "relative to a",
            "its axis, and around it the arc of its limits with a hand at the current angle",
            Anchors::together,
            Frames::axis,
            "Angle",
            true,
            limits_and_motor("rad", half_turn, "N m", "`[lower, upper]` angle"),
            {"x", "y", "z", "tilt about y", "tilt about z", "lower limit", "upper limit", "motor"}};
        return &info;
    }
    case JointType::slider: {
        static const JointTypeInfo info{
            type,
            "slider",
            "lets b move only along the axis, without rotating relative to a; the position is how "
            "far b's anchor is ahead of a's along the axis",
            "its rail, with a stop at each limit",
            Anchors::on_axis,
            Frames::axis,
            "Position",
            false,
            limits_and_motor("m", moderate, "N", "`[lower, upper]` position"),
            {"shift along y", "shift along z", "rotation about x", "rotation about y",
             "rotation about z", "lower limit", "upper limit", "motor"}};
        return &info;
    }
    case JointType::fixed: {
        static const JointTypeInfo info{
            type,
            "fixed",
            "holds two bodies together as if they were one; what rigid joints of this type without "
            "`break_force` connect, through however many, does not collide with itself",
            "a small cross",
            Anchors::together,
            Frames::whole,
            "",
            false,
            {},
            {"x", "y", "z", "rotation about x", "rotation about y", "rotation about z"}};
        return &info;
    }
    }
    return nullptr;
}

std::string text_of(const JointKey &key) {
    std::string names = "`" + std::string(key.name) + "`";
    std::string units(key.unit);
    if (key.is_angle()) {
        names += " *or* `" + std::string(key.name) + "_deg`";
        units += key.unit == "rad" ? " or degrees" : " or degrees/s";
    }
    const bool is_positive = key.bounds.min > 0;
    return "| " + names + " | " + units +
           (units.empty() ? ""
            : is_positive ? ", positive: "
                          : ": ") +
           std::string(key.about) +
           (key.needs.empty() ? "" : "; needs `" + std::string(key.needs) + "`") + " | " +
           std::string(key.by_default) + " |\n";
}

} // namespace

const std::vector<JointKey> &common_joint_keys() {
    static const std::vector<JointKey> keys{
        {"frequency", &JointDesc::frequency, "Hz", not_negative, "",
         "the natural frequency of its spring with the bodies on it", "0: rigid"},
        {"damping_ratio", &JointDesc::damping_ratio, "", not_negative, "frequency",
         "of that spring: at 1 or more it settles without oscillating", "1"},
        {"break_force", &JointDesc::break_force, "N", not_negative, "",
         "it breaks when holding its anchors takes more in any substep; a blow counts as "
         "spread over its substep",
         "0: never"},
        {"collide_connected", &JointDesc::collide_connected, "", yes_or_no, "",
         "whether the two bodies also collide with each other while it holds", "false"},
        {"broken", &JointDesc::broken, "", yes_or_no, "", "whether it has broken; for saved scenes",
         "false"}};
    return keys;
}

const JointTypeInfo &joint_type(JointType type) {
    const JointTypeInfo *info = find(type);
    PLUMB_CHECK(info != nullptr, "there is no joint type " << static_cast<int>(type));
    return *info;
}

std::span<const JointTypeInfo *const> joint_types() {
    static const std::vector<const JointTypeInfo *> all = [] {
        std::vector<const JointTypeInfo *> types;
        for (int i = 0; const JointTypeInfo *info = find(static_cast<JointType>(i)); ++i)
            types.push_back(info);
        return types;
    }();
    return all;
}

JointDesc as_read(JointDesc joint) {
    const JointTypeInfo &own = joint_type(joint.type);
    if (own.frames == JointTypeInfo::Frames::none)
        joint.frame_a_local = joint.frame_b_local = JointDesc{}.frame_a_local;
    const auto reads = [&](const JointKey &key) {
        return std::ranges::find(own.keys, key.name, &JointKey::name) != own.keys.end();
    };
    for (const JointTypeInfo *type : joint_types())
        for (const JointKey &key : type->keys)
            if (!reads(key))
                std::visit(
                    [&]<typename Member>(Member member) {
                        if constexpr (!std::is_same_v<Member, JointKey::Length>)
                            joint.*member = JointDesc{}.*member;
                    },
                    key.member);
    return joint;
}

std::string joint_reference() {
    std::string text = "| `type` | it | drawn as | `impulses` of |\n|---|---|---|---|\n";
    for (const JointTypeInfo *type : joint_types()) {
        text += "| `\"" + std::string(type->name) + "\"` | " + std::string(type->about) + " | " +
                std::string(type->drawn) + " | ";
        for (std::size_t i = 0; i < type->rows.size(); ++i)
            text += (i == 0 ? "" : ", ") + std::string(type->rows[i]);
        text += " |\n";
    }
    text += "\n| key of every joint | value | default |\n|---|---|---|\n";
    for (const JointKey &key : common_joint_keys())
        text += text_of(key);
    for (const JointTypeInfo *type : joint_types()) {
        if (type->keys.empty())
            continue;
        text +=
            "\n| key of `\"" + std::string(type->name) + "\"` | value | default |\n|---|---|---|\n";
        for (const JointKey &key : type->keys)
            text += text_of(key);
    }
    return text;
}

} // namespace plumb
