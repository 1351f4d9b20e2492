#include "engine/scene/file/joint.h"
#include "engine/scene/file/number.h"
#include "engine/scene/file/reading.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::scene_file {

namespace {

using Frames = JointTypeInfo::Frames;

struct JointEnd {
    std::optional<std::size_t> body; // none: the world
    std::optional<glm::dvec3> anchor_local;
    std::optional<glm::dquat> frame_local;
};

glm::dvec3 to_local(const SceneDesc &scene, const std::optional<std::size_t> &index,
                    const glm::dvec3 &world) {
    if (!index)
        return world;
    const BodyDesc &body = scene.bodies[*index];
    return glm::conjugate(body.orientation) * (world - body.position);
}

glm::dquat to_local(const SceneDesc &scene, const std::optional<std::size_t> &index,
                    const glm::dquat &world) {
    if (!index)
        return world;
    return glm::normalize(glm::conjugate(scene.bodies[*index].orientation) * world);
}

glm::dvec3 to_world(const SceneDesc &scene, const std::optional<std::size_t> &index,
                    const glm::dvec3 &local) {
    if (!index)
        return local;
    const BodyDesc &body = scene.bodies[*index];
    return body.position + body.orientation * local;
}

// The shortest rotation of the x axis to a unit direction. One that points back goes via its
// opposite, since the shortest rotation is ill-defined there.
glm::dquat frame_along(const glm::dvec3 &axis) {
    const bool is_back = axis.x < 0;
    const glm::dvec3 to = is_back ? -axis : axis;
    const glm::dquat turn = glm::normalize(glm::dquat{1 + to.x, 0, -to.z, to.y});
    return is_back ? turn * glm::dquat{0, 0, 0, 1} : turn;
}

// ---- anchors and frames ----

// `key` is anchor_a or anchor_b; `common` is the point given for both.
void read_anchor(Reading &reading, const JointTable &source, const std::string &key, bool is_world,
                 const std::optional<glm::dvec3> &common, JointEnd &end) {
    const Table &table = source.table;
    const std::string local_key = key + "_local";
    const std::string_view chosen = table.one_of({"anchor", key, local_key}, false, "");
    if (chosen.empty()) {
        const bool has_any = table.has("anchor") || table.has(key) || table.has(local_key);
        if (has_any)
            return;
        if (source.type.anchors != JointTypeInfo::Anchors::apart || is_world)
            reading.report.error(table.position(), table.title() + " has no " + key,
                                 "anchor = [x, y, z] is one world point for both bodies, " + key +
                                     " one for this body, " + local_key + " one in its frame");
        else
            end.anchor_local = glm::dvec3(0);
        return;
    }
    const std::optional<glm::dvec3> point =
        chosen == "anchor" ? common : table.vector(chosen, moderate);
    if (point)
        end.anchor_local = chosen == local_key ? *point : to_local(reading.scene, end.body, *point);
}

// Reports an error with the suggestion if only one of the keys is present.
void need_both(const Table &table, std::string_view a, std::string_view b,
               const std::string &suggestion) {
    if (table.has(a) != table.has(b))
        table.error(table.has(a) ? a : b,
                    table.title() + " has only one of " + std::string(a) + " and " + std::string(b),
                    suggestion);
}

// Reads one frame in the world, or a local frame for each body.
void read_frames(JointTable &source, JointEnd &a, JointEnd &b) {
    const Table &table = source.table;
    if (source.type.frames == Frames::none)
        return;
    if (source.type.frames == Frames::axis) {
        const std::string_view chosen =
            table.one_of({"axis", "frame_a_local"}, true,
                         "axis = [x, y, z] is a unit vector in world coordinates at the start");
        table.one_of({"axis", "frame_b_local"}, false, "");
        if (chosen == "axis")
            if (const std::optional<glm::dvec3> axis = table.unit_vector("axis"))
                source.frame = frame_along(*axis);
        if (chosen != "frame_a_local")
            return;
    }
    need_both(table, "frame_a_local", "frame_b_local", "a joint has a frame in each body");
    a.frame_local = table.unit_quaternion("frame_a_local");
    b.frame_local = table.unit_quaternion("frame_b_local");
}

// ---- the joint ----

bool add_joint(Reading &reading, const JointTable &source, const std::string &name,
               const JointEnd &a, const JointEnd &b) {
    JointDesc joint = source.joint;
    joint.name = name;
    if (a.body)
        joint.body_a = reading.scene.bodies[*a.body].name;
    if (b.body)
        joint.body_b = reading.scene.bodies[*b.body].name;
    joint.anchor_a_local = a.anchor_local.value_or(glm::dvec3(0));
    joint.anchor_b_local = b.anchor_local.value_or(glm::dvec3(0));
    if (source.type.frames != Frames::none) {
        joint.frame_a_local = a.frame_local.value_or(to_local(reading.scene, a.body, source.frame));
        joint.frame_b_local = b.frame_local.value_or(to_local(reading.scene, b.body, source.frame));
    }
    if (joint.type == JointType::distance && !source.has_length) {
        const double length = glm::distance(to_world(reading.scene, a.body, joint.anchor_a_local),
                                            to_world(reading.scene, b.body, joint.anchor_b_local));
        if (!(length >= positive.min && length <= positive.max)) {
            reading.report.error(source.table.position(),
                                 "the anchors of " + source.table.title() + " are " +
                                     shortest(length) + " m apart, which cannot be its length",
                                 "give it a length: " + std::string(positive.text));
            return false;
        }
        joint.min_length = joint.max_length = length;
    }
    reading.scene.joints.push_back(std::move(joint));
    reading.positions.joints.push_back(source.table.position());
    return true;
}

// Joins each copy of a repeated body to the next.
void read_chain(Reading &reading, JointTable &source, std::size_t errors) {
    const Table &table = source.table;
    table.refuse({"body_a", "body_b", "anchor", "anchor_a", "anchor_b"}, "a chain",
                 "its bodies are the copies of a repeated body, its anchors are in their frames: "
                 "anchor_a_local, anchor_b_local");
    need_both(table, "anchor_a_local", "anchor_b_local",
              "give both, or neither: a distance joint then connects the centres, any other sits "
              "halfway between them");
    JointEnd a;
    JointEnd b;
    a.anchor_local = table.vector("anchor_a_local", moderate);
    b.anchor_local = table.vector("anchor_b_local", moderate);
    const bool has_anchors = a.anchor_local.has_value();
    read_frames(source, a, b);
    const std::optional<std::string> chain = table.string("chain");
    if (!chain)
        return;
    const auto group = reading.groups.find(*chain);
    if (group == reading.groups.end()) {
        const bool is_single = reading.bodies_by_name.contains(*chain);
        table.error("chain",
                    is_single ? "the body " + in_quotes(*chain) + " is not repeated"
                              : "there is no body " + in_quotes(*chain),
                    is_single ? "a chain connects the copies of a body with repeat"
                              : reading.bodies.suggestion(*chain));
        return;
    }
    const std::size_t first = group->second.first;
    const std::size_t count = group->second.count;
    if (!group->second.is_complete)
        return; // its errors are already reported
    if (count < 2) {
        table.error("chain", "there is only one " + in_quotes(*chain),
                    "a chain needs at least two bodies");
        return;
    }
    if (reading.report.error_count() != errors ||
        !has_room_for(reading, count - 1, max_scene_joints, reading.scene.joints.size(), "joints",
                      table.position()))
        return;
    for (std::size_t i = 0; i + 1 < count; ++i) {
        const std::string name = source.joint.name + "_" + std::to_string(i);
        if (!reading.joints.add(reading.report, table.position("name"), "joint", name))
            return;
        a.body = first + i;
        b.body = first + i + 1;
        if (!has_anchors && source.type.anchors != JointTypeInfo::Anchors::apart) {
            const glm::dvec3 middle = 0.5 * (to_world(reading.scene, a.body, {0, 0, 0}) +
                                             to_world(reading.scene, b.body, {0, 0, 0}));
            a.anchor_local = to_local(reading.scene, a.body, middle);
            b.anchor_local = to_local(reading.scene, b.body, middle);
        }
        if (!add_joint(reading, source, name, a, b))
            return;
    }
}

void read_bodies(Reading &reading, const Table &table, const toml::table &toml, JointEnd &a,
                 JointEnd &b) {
    for (const auto &[end, body_key] : {std::pair(&a, "body_a"), std::pair(&b, "body_b")})
        if (const auto *name = toml.get_as<std::string>(body_key);
            table.has(body_key) && !(name && name->get() == "world"))
            end->body = find_body(reading, table, body_key);
    if (is_world(table, "body_a") && is_world(table, "body_b"))
        reading.report.error(table.position(), table.title() + " joins the world to itself",
                             "give body_a or body_b the name of a body");
    else if (a.body && b.body && *a.body == *b.body)
        table.error("body_b", table.title() + " joins a body to itself",
                    "body_a and body_b must differ");
}

void read_anchors(Reading &reading, JointTable &source, JointEnd &a, JointEnd &b) {
    const Table &table = source.table;
    const std::optional<glm::dvec3> common = table.vector("anchor", moderate);
    read_anchor(reading, source, "anchor_a", is_world(table, "body_a"), common, a);
    read_anchor(reading, source, "anchor_b", is_world(table, "body_b"), common, b);
}

} // namespace

void read_joint(Reading &reading, const toml::table &toml) {
    const Table table(reading.report, toml, title_of("joint", toml), joint_keys_in_files());
    const std::size_t errors = reading.report.error_count();
    JointDesc joint;
    joint.name = read_name(reading.report, table, "joint", reading.joints).value_or("");
    const bool is_chain = table.has("chain");
    JointEnd a;
    JointEnd b;
    if (!is_chain)
        read_bodies(reading, table, toml, a, b);
    const JointTypeInfo *type = read_joint_type(table);
    if (type == nullptr)
        return; // the other keys depend on the type
    JointTable source{table, *type, joint};
    read_joint_values(reading.report, source);
    if (is_chain) {
        read_chain(reading, source, errors);
        return;
    }
    read_anchors(reading, source, a, b);
    read_frames(source, a, b);
    if (reading.report.error_count() == errors &&
        has_room_for(reading, 1, max_scene_joints, reading.scene.joints.size(), "joints",
                     table.position()))
        add_joint(reading, source, joint.name, a, b);
}

} // namespace plumb::scene_file
