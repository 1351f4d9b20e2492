// What a caller can do to a running scene between two steps, as values that are executed, recorded
// and replayed. To add a command, add an alternative with its fields here and an `obey` in
// engine/scene/real/world_simulation.cpp.
#pragma once

#include "engine/dynamics/joints/grab_spring.h"
#include "engine/scene/scene_desc.h"

#include <string>
#include <string_view>
#include <variant>

namespace plumb {

// `name` is the command's name in a recording. each_field(command, visit) calls visit(key, field)
// for each field, or visit(key, field, or_default) for one that a recording may leave out. Bodies
// go by name; points and vectors are in world coordinates unless stated otherwise.

struct OrDefault {};
inline constexpr OrDefault or_default{};

// The body's name must be free.
struct AddBody {
    static constexpr std::string_view name = "add";
    BodyDesc body;
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("body", self.body);
    }
};

// Removes a body with its contacts and joints.
struct RemoveBody {
    static constexpr std::string_view name = "remove";
    std::string body;
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("body", self.body);
    }
};

// The joint's name must be free and its bodies there; anchors and frames are theirs, as in
// JointDesc. Fails under a method without joints.
struct AddJoint {
    static constexpr std::string_view name = "add_joint";
    JointDesc joint;
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("joint", self.joint);
    }
};

// Lets its bodies go; they stay. A broken joint can be removed, too.
struct RemoveJoint {
    static constexpr std::string_view name = "remove_joint";
    std::string joint;
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("joint", self.joint);
    }
};

// Teleports a body and sets its velocity; velocities stay 0 along locked axes and for static
// bodies.
struct SetMotion {
    static constexpr std::string_view name = "move";
    std::string body;
    glm::dvec3 position{0};
    glm::dquat orientation{1, 0, 0, 0};
    glm::dvec3 velocity{0};         // m/s
    glm::dvec3 angular_velocity{0}; // rad/s
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("body", self.body);
        visit("position", self.position);
        visit("orientation", self.orientation);
        visit("velocity", self.velocity);
        visit("angular_velocity", self.angular_velocity);
    }
};

// Changes a dynamic body's velocity immediately. Other bodies ignore it.
struct ApplyImpulse {
    static constexpr std::string_view name = "push";
    std::string body;
    glm::dvec3 impulse{0}; // N s
    glm::dvec3 point{0};
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("body", self.body);
        visit("impulse", self.impulse);
        visit("point", self.point);
    }
};

// Holds a point of a dynamic body at a target with a damped spring of limited force, until it is
// released or the body removed. A second grab replaces the first. Other bodies ignore it.
struct GrabBody {
    static constexpr std::string_view name = "grab";
    std::string body;
    glm::dvec3 point{0}; // in the body's frame
    glm::dvec3 target{0};
    double max_force = 0; // N
    GrabSpring spring{};
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("body", self.body);
        visit("point", self.point);
        visit("target", self.target);
        visit("max_force", self.max_force);
        visit("frequency", self.spring.frequency, or_default);
        visit("damping_ratio", self.spring.damping_ratio, or_default);
    }
};

// Grabs a particle, by its own name or its name in a cloth ("sheet[3,4]"). Pinned particles ignore
// it.
struct GrabParticle {
    static constexpr std::string_view name = "grab_particle";
    std::string particle;
    glm::dvec3 target{0};
    double max_force = 0; // N
    GrabSpring spring{};
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("particle", self.particle);
        visit("target", self.target);
        visit("max_force", self.max_force);
        visit("frequency", self.spring.frequency, or_default);
        visit("damping_ratio", self.spring.damping_ratio, or_default);
    }
};

// Does nothing when nothing is held.
struct MoveGrab {
    static constexpr std::string_view name = "drag";
    glm::dvec3 target{0};
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("target", self.target);
    }
};

struct ReleaseGrab {
    static constexpr std::string_view name = "release";
    template <typename Self, typename Visit> static void each_field(Self &, Visit &&) {}
};

// Leaves the settings as they are.
struct SetMethod {
    static constexpr std::string_view name = "method";
    std::string method;
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("method", self.method);
    }
};

// Settings that are not given stay as they are.
struct SetSettings {
    static constexpr std::string_view name = "settings";
    GivenSettings settings;
    template <typename Self, typename Visit> static void each_field(Self &self, Visit &&visit) {
        visit("settings", self.settings);
    }
};

using Command = std::variant<AddBody, RemoveBody, AddJoint, RemoveJoint, SetMotion, ApplyImpulse,
                             GrabBody, GrabParticle, MoveGrab, ReleaseGrab, SetMethod, SetSettings>;

} // namespace plumb
