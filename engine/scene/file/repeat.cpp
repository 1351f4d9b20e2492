#include "engine/scene/file/reading.h"
#include "engine/scene/file/spelling.h"

namespace plumb::scene_file {

namespace {

glm::ivec3 read_counts(const Table &table, std::int64_t most) {
    const toml::node &node = *table.node("count");
    const toml::array *array = node.as_array();
    if (!array || array->size() != 3) {
        table.error("count",
                    array ? "count has " + std::to_string(array->size()) + " elements"
                          : "count is " + std::string(type_name(node)),
                    "it must be an array of 3 whole numbers");
        return glm::ivec3(1);
    }
    glm::ivec3 counts{1};
    for (int i = 0; i < 3; ++i)
        counts[i] = static_cast<int>(table
                                         .integer(*array->get(static_cast<std::size_t>(i)),
                                                  "count[" + std::to_string(i) + "]", 1, most)
                                         .value_or(1));
    return counts;
}

// Independent of the body's position, so that rounding does not make equal bodies differ.
double height_of(BodyDesc body) {
    body.position = glm::dvec3(0);
    const BoundsDesc around = bounds(body);
    return around.max.y - around.min.y;
}

} // namespace

std::optional<Repeat> read_repeat(Report &report, const toml::table &source,
                                  const std::string &title, const BodyDesc &body, bool has_shape) {
    static constexpr std::array<std::string_view, 6> kinds{"grid",    "stack", "line",
                                                           "pyramid", "ring",  "scatter"};
    static constexpr std::array<std::string_view, 3> grid_keys{"kind", "count", "spacing"};
    static constexpr std::array<std::string_view, 4> stack_keys{"kind", "count", "spacing",
                                                                "turn_deg"};
    static constexpr std::array<std::string_view, 3> line_keys{"kind", "count", "step"};
    static constexpr std::array<std::string_view, 4> pyramid_keys{"kind", "base", "spacing",
                                                                  "square"};
    static constexpr std::array<std::string_view, 4> ring_keys{"kind", "count", "radius", "facing"};
    static constexpr std::array<std::string_view, 5> scatter_keys{
        "kind", "count", "half_extents", "min_distance", "random_rotation"};
    static constexpr std::array<Words, 6> keys{grid_keys,    stack_keys, line_keys,
                                               pyramid_keys, ring_keys,  scatter_keys};
    std::string name = "repeat of " + title;
    // The valid keys depend on the kind, so look that up first.
    const auto *kind_node = source.get_as<std::string>("kind");
    const auto found =
        kind_node ? std::find(kinds.begin(), kinds.end(), kind_node->get()) : kinds.end();
    if (found == kinds.end()) {
        report.error(
            source.contains("kind") ? position_of(*source.get("kind")) : position_of(source),
            kind_node ? "unknown kind " + in_quotes(kind_node->get()) + " of repeat"
                      : name + " has no kind",
            kind_node ? did_you_mean(kind_node->get(), kinds)
                      : R"(kind = "grid", "stack", "line", "pyramid", "ring" or "scatter")");
        return std::nullopt;
    }
    const auto kind = static_cast<std::size_t>(found - kinds.begin());
    const Table table(report, source, "the " + std::string(kinds[kind]) + " " + name, keys[kind]);
    constexpr std::int64_t most = max_scene_bodies;
    const auto count = [&](std::string_view key) -> int {
        return table.require(key, "how many, a whole number")
                   ? static_cast<int>(table.integer(key, 1, most).value_or(1))
                   : 1;
    };
    switch (kind) {
    case 0: {
        GridRepeat grid;
        if (table.require("count", "count = [nx, ny, nz]"))
            grid.count = read_counts(table, most);
        if (table.require("spacing", "spacing = [x, y, z] in metres"))
            grid.spacing = table.vector("spacing", positive).value_or(grid.spacing);
        return grid;
    }
    case 1: {
        StackRepeat stack{count("count"), 0, 0};
        if (has_plane(body) && !table.has("spacing"))
            table.require("spacing", "a plane has no height to take it from");
        else if (has_shape)
            stack.spacing = height_of(body);
        stack.spacing = table.number("spacing", positive).value_or(stack.spacing);
        stack.turn = table.number("turn_deg", moderate).value_or(0) * degree;
        return stack;
    }
    case 2: {
        LineRepeat line{count("count"), {}};
        if (table.require("step", "step = [x, y, z] in metres, from one to the next"))
            line.step = table.vector("step", moderate).value_or(line.step);
        return line;
    }
    case 3: {
        PyramidRepeat pyramid{count("base"), {}, table.boolean("square").value_or(false)};
        if (table.require("spacing", "spacing = [sideways, up] in metres"))
            if (const auto spacing = table.numbers<2>("spacing", positive))
                pyramid.spacing = {(*spacing)[0], (*spacing)[1]};
        return pyramid;
    }
    case 4: {
        RingRepeat ring{count("count"), 1, table.boolean("facing").value_or(false)};
        if (table.require("radius", "radius = metres"))
            ring.radius = table.number("radius", positive).value_or(ring.radius);
        return ring;
    }
    default: {
        ScatterRepeat scatter;
        scatter.count = count("count");
        scatter.random_rotation = table.boolean("random_rotation").value_or(false);
        scatter.min_distance = table.number("min_distance", positive).value_or(0);
        if (table.require("half_extents", "half_extents = [x, y, z] in metres of the region"))
            scatter.half_extents =
                table.vector("half_extents", not_negative).value_or(scatter.half_extents);
        return scatter;
    }
    }
}

} // namespace plumb::scene_file
