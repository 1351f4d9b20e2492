#include "engine/scene/scene_file_reading.h"

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
    static constexpr std::array<std::string_view, 7> keys{
        "body_a", "body_b", "child_a", "child_b", "triangle", "features", "impulses"};
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
                        "a shape is counted from 0 to " + std::to_string(most_children));
        *child = static_cast<std::uint32_t>(given);
    }
    if (const std::optional<std::uint64_t> triangle = table.natural("triangle"))
        contact.triangle = static_cast<std::uint32_t>(*triangle);
    const toml::array *features = array_at(table, "features");
    const toml::array *impulses = array_at(table, "impulses");
    if (!features || !impulses)
        return;
    if (features->size() != impulses->size()) {
        table.error("impulses",
                    "there are " + std::to_string(features->size()) + " features and " +
                        std::to_string(impulses->size()) + " impulses",
                    "there must be as many of one as of the other");
        return;
    }
    for (std::size_t i = 0; i < features->size(); ++i) {
        const std::string index = "[" + std::to_string(i) + "]";
        const std::optional<std::int64_t> feature = table.integer(
            *features->get(i), "features" + index, 0, std::numeric_limits<std::uint32_t>::max());
        const auto impulse = table.numbers<3>(*impulses->get(i), "impulses" + index, finite);
        if (feature && impulse)
            contact.points.push_back({static_cast<std::uint32_t>(*feature),
                                      {(*impulse)[0], (*impulse)[1], (*impulse)[2]}});
    }
    reading.scene.contacts.push_back(std::move(contact));
}

} // namespace

void read_state(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 2> keys{"step", "contact"};
    const Table table(reading.report, source, "[state]", keys);
    reading.scene.step_count = table.natural("step").value_or(0);
    for_each(
        reading.report, table, "contact",
        [&](const toml::table &contact) { read_contact(reading, contact); }, "state.contact");
}

} // namespace plumb::scene_file
