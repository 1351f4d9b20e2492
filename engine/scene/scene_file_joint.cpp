#include "engine/scene/scene_file_number.h"
#include "engine/scene/scene_file_reading.h"

#include <glm/geometric.hpp>

namespace plumb::scene_file {

namespace {

struct JointEnd {
    std::optional<std::size_t> body; // none: the world
    std::optional<glm::dvec3> anchor_local;
};

bool is_world(const Table &table, std::string_view key) {
    const toml::node *node = table.node(key);
    return node == nullptr || (node->is_string() && node->as_string()->get() == "world");
}

glm::dvec3 to_local(const SceneDesc &scene, const std::optional<std::size_t> &index,
                    const glm::dvec3 &world) {
    if (!index)
        return world;
    const BodyDesc &body = scene.bodies[*index];
    return glm::conjugate(body.orientation) * (world - body.position);
}

glm::dvec3 to_world(const SceneDesc &scene, const std::optional<std::size_t> &index,
                    const glm::dvec3 &local) {
    if (!index)
        return local;
    const BodyDesc &body = scene.bodies[*index];
    return body.position + body.orientation * local;
}

// `key` is anchor_a or anchor_b; `common` is the point that stands for both.
void read_anchor(Reading &reading, const Table &table, const std::string &key, bool is_world,
                 JointType type, const std::optional<glm::dvec3> &common, JointEnd &end) {
    const std::string local_key = key + "_local";
    const std::string_view chosen = table.one_of({"anchor", key, local_key}, false, "");
    if (chosen.empty()) {
        const bool has_any = table.has("anchor") || table.has(key) || table.has(local_key);
        if (has_any)
            return;
        if (type == JointType::ball || is_world)
            reading.report.error(table.position(), table.title() + " has no " + key,
                                 "anchor = [x, y, z] is one point of the world for both bodies, " +
                                     key + " one for this body, " + local_key +
                                     " one in its frame");
        else
            end.anchor_local = glm::dvec3(0);
        return;
    }
    const std::optional<glm::dvec3> point =
        chosen == "anchor" ? common : table.vector(chosen, moderate);
    if (point)
        end.anchor_local = chosen == local_key ? *point : to_local(reading.scene, end.body, *point);
}

bool add_joint(Reading &reading, const Table &table, JointDesc joint, const JointEnd &a,
               const JointEnd &b, std::optional<double> length) {
    if (a.body)
        joint.body_a = reading.scene.bodies[*a.body].name;
    if (b.body)
        joint.body_b = reading.scene.bodies[*b.body].name;
    joint.anchor_a_local = a.anchor_local.value_or(glm::dvec3(0));
    joint.anchor_b_local = b.anchor_local.value_or(glm::dvec3(0));
    if (joint.type == JointType::distance) {
        joint.max_length =
            length.value_or(glm::distance(to_world(reading.scene, a.body, joint.anchor_a_local),
                                          to_world(reading.scene, b.body, joint.anchor_b_local)));
        joint.min_length = joint.max_length;
        if (!(joint.max_length >= positive.min && joint.max_length <= positive.max)) {
            reading.report.error(table.position(),
                                 "the anchors of " + table.title() + " are " +
                                     shortest(joint.max_length) +
                                     " m apart, which cannot be its length",
                                 "give a length of its own: " + std::string(positive.text));
            return false;
        }
    }
    reading.scene.joints.push_back(std::move(joint));
    reading.positions.joints.push_back(table.position());
    return true;
}

// One joint between each of a repeated body's copies and the next.
void read_chain(Reading &reading, const Table &table, const JointDesc &joint,
                std::optional<double> length, std::size_t errors) {
    table.refuse({"body_a", "body_b", "anchor", "anchor_a", "anchor_b"}, "a chain",
                 "its bodies are the copies of a repeated one, its anchors in their frames: "
                 "anchor_a_local, anchor_b_local");
    if (table.has("anchor_a_local") != table.has("anchor_b_local"))
        table.error(table.has("anchor_a_local") ? "anchor_a_local" : "anchor_b_local",
                    table.title() + " has only one of anchor_a_local and anchor_b_local",
                    "give both, or neither: then a ball joint sits halfway between the centres, "
                    "and a distance joint holds the centres");
    const std::optional<glm::dvec3> anchor_a = table.vector("anchor_a_local", moderate);
    const std::optional<glm::dvec3> anchor_b = table.vector("anchor_b_local", moderate);
    const std::optional<std::string> chain = table.string("chain");
    if (!chain)
        return;
    const auto group = reading.groups.find(*chain);
    if (group == reading.groups.end()) {
        const bool is_single = reading.bodies_by_name.contains(*chain);
        table.error("chain",
                    is_single ? "the body " + in_quotes(*chain) + " is not repeated"
                              : "there is no body " + in_quotes(*chain),
                    is_single ? "a chain runs through the copies of a body with repeat"
                              : reading.bodies.suggestion(*chain));
        return;
    }
    const std::size_t first = group->second.first;
    const std::size_t count = group->second.count;
    if (!group->second.is_complete)
        return; // its mistakes are reported already
    if (count < 2) {
        table.error("chain", "there is only one " + in_quotes(*chain),
                    "a chain needs two bodies at least");
        return;
    }
    if (reading.report.error_count() != errors ||
        !has_room_for(reading, count - 1, max_scene_joints, reading.scene.joints.size(), "joints",
                      table.position()))
        return;
    for (std::size_t i = 0; i + 1 < count; ++i) {
        JointDesc copy = joint;
        copy.name += "_" + std::to_string(i);
        if (!reading.joints.add(reading.report, table.position("name"), "joint", copy.name))
            return;
        JointEnd a{first + i, anchor_a};
        JointEnd b{first + i + 1, anchor_b};
        if (!anchor_a) {
            const glm::dvec3 middle = 0.5 * (to_world(reading.scene, a.body, {0, 0, 0}) +
                                             to_world(reading.scene, b.body, {0, 0, 0}));
            const bool is_ball = joint.type == JointType::ball;
            a.anchor_local = is_ball ? to_local(reading.scene, a.body, middle) : glm::dvec3(0);
            b.anchor_local = is_ball ? to_local(reading.scene, b.body, middle) : glm::dvec3(0);
        }
        if (!add_joint(reading, table, copy, a, b, length))
            return;
    }
}

} // namespace

void read_joint(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 13> keys{"name",
                                                           "type",
                                                           "body_a",
                                                           "body_b",
                                                           "anchor",
                                                           "anchor_a",
                                                           "anchor_b",
                                                           "anchor_a_local",
                                                           "anchor_b_local",
                                                           "length",
                                                           "collide_connected",
                                                           "impulse",
                                                           "chain"};
    static constexpr std::array<std::string_view, 2> types{"ball", "distance"};
    const Table table(reading.report, source, title_of("joint", source), keys);
    const std::size_t errors = reading.report.error_count();
    JointDesc joint;
    joint.name = read_name(reading.report, table, "joint", reading.joints).value_or("");
    if (table.require("type", R"(type = "ball" or "distance")"))
        joint.type =
            table.choice("type", types).value_or(0) == 0 ? JointType::ball : JointType::distance;
    joint.collide_connected = table.boolean("collide_connected").value_or(false);
    if (const std::optional<glm::dvec3> impulse = table.vector("impulse", finite))
        joint.impulses = {impulse->x, impulse->y, impulse->z};
    if (joint.type == JointType::ball && table.has("type"))
        table.refuse({"length"}, "a ball joint", R"(type = "distance" has a length)");
    const std::optional<double> length = table.number("length", positive);
    if (table.has("chain")) {
        read_chain(reading, table, joint, length, errors);
        return;
    }

    JointEnd a;
    JointEnd b;
    for (const auto &[end, body_key] : {std::pair(&a, "body_a"), std::pair(&b, "body_b")})
        if (const auto *name = source.get_as<std::string>(body_key);
            table.has(body_key) && !(name && name->get() == "world"))
            end->body = find_body(reading, table, body_key);
    const bool is_world_a = is_world(table, "body_a");
    const bool is_world_b = is_world(table, "body_b");
    if (is_world_a && is_world_b)
        reading.report.error(table.position(), table.title() + " joins the world to itself",
                             "give body_a or body_b the name of a body");
    else if (a.body && b.body && *a.body == *b.body)
        table.error("body_b", table.title() + " joins a body to itself",
                    "body_a and body_b must differ");
    const std::optional<glm::dvec3> common = table.vector("anchor", moderate);
    read_anchor(reading, table, "anchor_a", is_world_a, joint.type, common, a);
    read_anchor(reading, table, "anchor_b", is_world_b, joint.type, common, b);
    if (reading.report.error_count() != errors ||
        !has_room_for(reading, 1, max_scene_joints, reading.scene.joints.size(), "joints",
                      table.position()))
        return;
    add_joint(reading, table, joint, a, b, length);
}

} // namespace plumb::scene_file
