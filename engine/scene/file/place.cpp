#include "engine/scene/file/place.h"

namespace plumb::scene_file {

std::optional<glm::dvec3> place(const Table &table, const toml::node &node, const std::string &name,
                                bool flat, const Bounds &bounds) {
    if (flat) {
        const auto n = table.numbers<2>(node, name, bounds);
        return n ? std::optional(glm::dvec3((*n)[0], (*n)[1], 0)) : std::nullopt;
    }
    const auto n = table.numbers<3>(node, name, bounds);
    return n ? std::optional(glm::dvec3((*n)[0], (*n)[1], (*n)[2])) : std::nullopt;
}

std::optional<glm::dvec3> place(const Table &table, std::string_view key, bool flat,
                                const Bounds &bounds) {
    const toml::node *node = table.node(key);
    return node ? place(table, *node, std::string(key), flat, bounds) : std::nullopt;
}

std::vector<glm::dvec3> places(const Table &table, std::string_view key, bool flat) {
    std::vector<glm::dvec3> all;
    const toml::node *node = table.node(key);
    if (!node)
        return all;
    const toml::array *array = node->as_array();
    if (!array) {
        table.wrong_type(*node, std::string(key), "an array of points");
        return all;
    }
    for (std::size_t i = 0; i < array->size(); ++i)
        if (const auto point =
                place(table, *array->get(i), std::string(key) + "[" + std::to_string(i) + "]", flat,
                      moderate))
            all.push_back(*point);
    return all;
}

} // namespace plumb::scene_file
