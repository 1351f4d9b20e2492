#include "engine/dynamics/joints/grab_spring.h"
#include "engine/scene/file/particle.h"
#include "engine/scene/file/reading.h"

#include <limits>

namespace plumb::scene_file {

namespace {

const toml::array *array_at(const Table &table, std::string_view key) {
    if (!table.require(key, "an array, one element for each contact point"))
        return nullptr;
    const toml::node *node = table.node(key);
    if (!node->as_array())
        table.wrong_type(*node, std::string(key), "an array");
    return node->as_array();
}

void read_contact(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 14> keys{
        "body_a",  "body_b",  "child_a", "child_b", "triangle",   "features",   "impulses",
        "cores_a", "cores_b", "normal",  "offset",  "rotation_a", "rotation_b", "penalties"};
    const Table table(reading.report, source, "[[state.contact]]", keys);
    ContactStateDesc contact;
    for (const auto &[key, name] :
         {std::pair("body_a", &contact.body_a), std::pair("body_b", &contact.body_b)})
        if (table.require(key, "the name of a body"))
            if (const std::optional<std::size_t> body = find_body(reading, table, key))
                *name = reading.scene.bodies[*body].name;
    if (!contact.body_a.empty() && contact.body_a == contact.body_b)
        table.error("body_b", "a body is in contact with itself", "body_a and body_b must differ");
    constexpr std::uint64_t most_children = std::numeric_limits<std::uint16_t>::max();
    for (const auto &[key, child] :
         {std::pair("child_a", &contact.child_a), std::pair("child_b", &contact.child_b)}) {
        const std::uint64_t given = table.natural(key).value_or(0);
        if (given > most_children)
            table.error(key, "no body has a shape " + std::to_string(given),
                        "shapes are numbered from 0 to " + std::to_string(most_children));
        *child = static_cast<std::uint32_t>(given);
    }
    if (const std::optional<std::uint64_t> triangle = table.natural("triangle")) {
        constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max() - 1;
        if (*triangle > most)
            table.error("triangle", "no surface has a triangle " + std::to_string(*triangle),
                        "triangles are numbered from 0; " + std::to_string(most) +
                            " stands for the inside of a solid surface");
        contact.triangle = static_cast<std::uint32_t>(std::min(*triangle, most));
    }
    const toml::array *features = array_at(table, "features");
    static constexpr std::array<std::string_view, 3> vectors{"impulses", "cores_a", "cores_b"};
    std::array<const toml::array *, 3> arrays{};
    // The points on the bodies are optional; without them the contact is found again.
    for (std::size_t i = 0; i < vectors.size(); ++i)
        if (i == 0 || table.has(vectors[i])) {
            arrays[i] = array_at(table, vectors[i]);
            if (!arrays[i])
                return;
        }
    const toml::array *penalties = nullptr;
    if (table.has("penalties")) {
        penalties = array_at(table, "penalties");
        if (!penalties)
            return;
    }
    if (!features)
        return;
    const auto is_as_many = [&](std::string_view key, const toml::array *array) {
        if (array == nullptr || array->size() == features->size())
            return true;
        table.error(key,
                    "there are " + std::to_string(features->size()) + " features and " +
                        std::to_string(array->size()) + " " + std::string(key),
                    "the numbers must match");
        return false;
    };
    for (std::size_t i = 0; i < vectors.size(); ++i)
        if (!is_as_many(vectors[i], arrays[i]))
            return;
    if (!is_as_many("penalties", penalties))
        return;
    for (std::size_t i = 0; i < features->size(); ++i) {
        const std::string index = "[" + std::to_string(i) + "]";
        const std::optional<std::int64_t> feature = table.integer(
            *features->get(i), "features" + index, 0, std::numeric_limits<std::uint32_t>::max());
        ContactStateDesc::Point point;
        point.feature = static_cast<std::uint32_t>(feature.value_or(0));
        const std::array<glm::dvec3 *, 3> members{&point.impulse, &point.core_a, &point.core_b};
        bool is_read = feature.has_value();
        for (std::size_t k = 0; k < vectors.size(); ++k) {
            if (!arrays[k])
                continue;
            if (const auto read =
                    table.numbers<3>(*arrays[k]->get(i), std::string(vectors[k]) + index, finite))
                *members[k] = {(*read)[0], (*read)[1], (*read)[2]};
            else
                is_read = false;
        }
        if (penalties) {
            if (const auto read = table.numbers<4>(*penalties->get(i), "penalties" + index, finite))
                point.penalty = *read;
            else
                is_read = false;
        }
        if (is_read)
            contact.points.push_back(point);
    }
    contact.normal = table.vector("normal", finite).value_or(contact.normal);
    contact.offset = table.vector("offset", finite).value_or(contact.offset);
    contact.rotation_a = table.unit_quaternion("rotation_a").value_or(contact.rotation_a);
    contact.rotation_b = table.unit_quaternion("rotation_b").value_or(contact.rotation_b);
    reading.scene.contacts.push_back(std::move(contact));
}

// The same bounds as in the grab command.
constexpr Bounds no_less_than_0{0, std::numeric_limits<double>::max(), "a number of at least 0"};

// As with the grab commands, static bodies and pinned particles are not held.
void read_grab(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 9> keys{
        "body",      "particle",      "point",   "target",   "max_force",
        "frequency", "damping_ratio", "impulse", "held_mass"};
    const Table table(reading.report, source, "[state.grab]", keys);
    GrabStateDesc grab;
    const std::string_view held =
        table.one_of({"body", "particle"}, true, "a grab holds one body, or one particle");
    if (held == "body") {
        if (const std::optional<std::size_t> body = find_body(reading, table, "body"))
            grab.body = reading.scene.bodies[*body].name;
        table.refuse({"held_mass"}, "a grab of a body", "it has the mass of its body");
        grab.point_local = table.vector("point", finite).value_or(grab.point_local);
        grab.impulse = table.vector("impulse", finite).value_or(grab.impulse);
    } else if (held == "particle") {
        grab.particle = table.string("particle").value_or("");
        if (!is_particle(reading, grab.particle))
            table.error("particle", "there is no particle " + in_quotes(grab.particle));
        table.refuse({"point", "impulse"}, "a grab of a particle", "a spring holds it as a point");
        grab.held_mass = table.number("held_mass", no_less_than_0).value_or(grab.held_mass);
    }
    if (table.require("target", "[x, y, z] in m"))
        grab.target = table.vector("target", finite).value_or(grab.target);
    if (table.require("max_force", "the greatest force, in N"))
        grab.max_force = table.number("max_force", no_less_than_0).value_or(grab.max_force);
    const GrabSpring spring;
    grab.frequency = table.number("frequency", above_zero).value_or(spring.frequency);
    grab.damping_ratio =
        table.number("damping_ratio", no_less_than_0).value_or(spring.damping_ratio);
    reading.scene.grab = std::move(grab);
}

void read_clock(Reading &reading, const Table &table) {
    SceneDesc &scene = reading.scene;
    scene.step_count = table.natural("step").value_or(0);
    scene.dt_since_step = table.natural("dt_since_step").value_or(0);
    scene.dt_since_time = table.number("dt_since_time", not_negative).value_or(0);
    if (scene.dt_since_step > scene.step_count)
        table.error("dt_since_step",
                    "dt was changed after step " + std::to_string(scene.dt_since_step) + " of " +
                        std::to_string(scene.step_count),
                    "it must be at most `step`");
    if (scene.dt_since_step == 0 && scene.dt_since_time > 0)
        table.error("dt_since_time", "dt was changed at a time, but after no step",
                    "dt_since_step says after which");
}

} // namespace

void read_state(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 5> keys{"step", "dt_since_step", "dt_since_time",
                                                          "grab", "contact"};
    const Table table(reading.report, source, "[state]", keys);
    read_clock(reading, table);
    if (const toml::table *grab = table_at(reading.report, table, "grab"))
        read_grab(reading, *grab);
    for_each(
        reading.report, table, "contact",
        [&](const toml::table &contact) { read_contact(reading, contact); }, "state.contact");
}

} // namespace plumb::scene_file
