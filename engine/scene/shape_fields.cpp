#include "engine/scene/shape_fields.h"

#include <type_traits>

namespace plumb::scene_file {

namespace {

template <typename Shape, typename... Kinds>
constexpr bool is_one_of(const std::variant<Kinds...> *) {
    return (std::is_same_v<Shape, Kinds> || ...);
}

std::string_view of_bodies(const KindInfo &info) {
    switch (info.moves) {
    case Moves::by_forces:
        return "any";
    case Moves::as_told:
        return "static or kinematic";
    case Moves::never:
        return "static";
    }
    return "";
}

std::string_view of_probes(const KindInfo &info) {
    switch (info.placing) {
    case Placing::by_its_points:
        return "";
    case Placing::position:
        return "`position`";
    case Placing::position_and_rotation:
        return "`position`, a rotation";
    }
    return "";
}

template <typename Shape> std::string row() {
    const KindInfo &info = Kind<Shape>::info;
    constexpr bool has_body = is_one_of<Shape>(static_cast<const ShapeDesc *>(nullptr));
    std::string text = "| `\"" + std::string(info.name) + "\"` | " + fields_of<Shape>().text();
    for (const std::string_view cell :
         {has_body ? of_bodies(info) : std::string_view("none"), of_probes(info), info.about})
        text += cell.empty() ? " |" : " | " + std::string(cell);
    return text + " |\n";
}

template <typename... Kinds> std::string rows(const std::variant<Kinds...> *) {
    return (row<Kinds>() + ...);
}

} // namespace

std::string shape_reference() {
    return "| shape | its fields | bodies | placed in a probe by | what "
           "|\n|---|---|---|---|---|\n" +
           rows(static_cast<const ProbeShape *>(nullptr));
}

} // namespace plumb::scene_file
