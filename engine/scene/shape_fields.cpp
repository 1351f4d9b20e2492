#include "engine/scene/shape_fields.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <type_traits>
#include <variant>

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

// A visitor that summarises a kind's fields in a few words.
class Summary {
  public:
    explicit Summary(std::string_view kind) : text_(kind) { std::ranges::replace(text_, '_', ' '); }

    void length(std::string_view key, double &value, std::string_view = {}) {
        std::string name(key);
        std::ranges::replace(name, '_', ' ');
        text_ += ", " + name + " " + rounded(value) + " m";
    }
    void size(std::string_view, glm::dvec3 &half) {
        text_ += ", " + rounded(2 * half.x) + " × " + rounded(2 * half.y) + " × " +
                 rounded(2 * half.z) + " m";
    }
    template <typename Points> void cloud(std::string_view, Points &points) {
        text_ += " of " + std::to_string(points->size()) + " points";
    }
    template <typename... Ways> void either(std::string_view, const Ways &...ways) {
        ((ways.is_chosen ? ways.fields() : void()), ...);
    }
    void file(ShapeFile &file) { text_ += " of " + file.name; }
    template <typename Word, std::size_t count>
    void word(std::string_view key, Word &word, const std::array<std::string_view, count> &names,
              bool) {
        text_ += ", " + std::string(key) + " " + std::string(names[static_cast<std::size_t>(word)]);
    }
    void whole(std::string_view, int &, int, int) {}
    template <typename Data> void surface(std::string_view, std::string_view, Data &data) {
        text_ += " of " + std::to_string(data->triangles.size()) + " triangles";
    }
    void heights(std::string_view, HeightFieldDesc &field) {
        text_ += " of " + std::to_string(field.rows) + " × " + std::to_string(field.columns);
    }

    const std::string &text() const { return text_; }

  private:
    static std::string rounded(double value) {
        std::array<char, 32> text{};
        std::snprintf(text.data(), text.size(), "%.4g", value);
        return text.data();
    }

    std::string text_;
};

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
    return "| shape | fields | bodies | placed in a probe by | what it is "
           "|\n|---|---|---|---|---|\n" +
           rows(static_cast<const ProbeShape *>(nullptr));
}

} // namespace plumb::scene_file

std::string plumb::summary(const ShapeDesc &shape) {
    return std::visit(
        [](auto known) { // a copy: visitors may write
            using Shape = decltype(known);
            scene_file::Summary words(scene_file::Kind<Shape>::info.name);
            scene_file::Kind<Shape>::fields(known, words);
            return words.text();
        },
        shape);
}
