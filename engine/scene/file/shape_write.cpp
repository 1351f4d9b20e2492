#include "engine/scene/file/shape_write.h"

#include "engine/scene/file/number.h"
#include "engine/scene/file/text.h"
#include "engine/scene/shape_kinds.h"

namespace plumb::scene_file {

namespace {

using Fields = std::vector<std::string>;

std::string listed(const Fields &values) {
    std::string text;
    for (const std::string &value : values)
        text += (text.empty() ? "" : ", ") + value;
    return text;
}

template <typename Shape> Fields fields_of_shape(const Shape &shape);

// A visitor that writes a kind's fields.
class FieldWriter {
  public:
    FieldWriter(Fields &fields, bool is_flat) : fields_(fields), is_flat_(is_flat) {}

    void length(std::string_view key, double &value, std::string_view = {}) {
        add(key, shortest(value));
    }
    void size(std::string_view key, glm::dvec3 &value) { add(key, place_text(value, is_flat_)); }
    void turn(std::string_view key, double &value) {
        fields_.push_back(angle_in_line(std::string(key), value));
    }
    template <std::size_t count>
    void corners(std::string_view key, std::array<glm::dvec3, count> &value) {
        add(key, places_text({value.begin(), value.end()}, is_flat_));
    }
    template <typename Points> void cloud(std::string_view key, Points &value) {
        add(key, places_text(*value, false));
    }
    template <typename... Ways> void either(std::string_view, const Ways &...ways) {
        (run(ways), ...);
    }
    void file(ShapeFile &value) {
        add("file", string(value.name));
        add("scale", shortest(value.scale));
    }
    template <typename Word, std::size_t count>
    void word(std::string_view key, Word &value, const std::array<std::string_view, count> &names,
              bool is_optional) {
        if (!is_optional || value != Word{})
            add(key, string(names[static_cast<std::size_t>(value)]));
    }
    void whole(std::string_view key, int &value, int, int) { add(key, std::to_string(value)); }
    template <typename Data>
    void surface(std::string_view vertices, std::string_view triangles, Data &value) {
        add(vertices, places_text(value->vertices, false));
        Fields all;
        for (const auto &[a, b, c] : value->triangles)
            all.push_back("[" + std::to_string(a) + ", " + std::to_string(b) + ", " +
                          std::to_string(c) + "]");
        add(triangles, "[" + listed(all) + "]");
    }
    void heights(std::string_view key, HeightFieldDesc &field) {
        Fields rows;
        auto next = field.heights->begin();
        for (int row = 0; row < field.rows; ++row) {
            Fields heights;
            for (int column = 0; column < field.columns; ++column)
                heights.push_back(shortest(*next++));
            rows.push_back("[" + listed(heights) + "]");
        }
        add(key, "[" + listed(rows) + "]");
    }
    void parts(std::string_view key, std::vector<FlatPartDesc> &value) {
        Fields all;
        for (const FlatPartDesc &part : value) {
            Fields fields = fields_of_shape(part.shape);
            fields.push_back("position = " + place_text(part.position, true));
            all.push_back("{ " + listed(fields) + " }");
        }
        add(key, "[" + listed(all) + "]");
    }

  private:
    template <typename AnyWay> void run(const AnyWay &way) const {
        if (way.is_chosen)
            way.fields();
    }
    void add(std::string_view key, const std::string &value) {
        fields_.push_back(std::string(key) + " = " + value);
    }

    Fields &fields_;
    bool is_flat_;
};

template <typename Shape> Fields fields_of_shape(const Shape &shape) {
    Shape copy = shape; // visitors may write
    return std::visit(
        []<typename S>(S &of_kind) {
            Fields fields{"shape = " + string(Kind<S>::info.name)};
            FieldWriter writer(fields, Kind<S>::info.is_flat);
            Kind<S>::fields(of_kind, writer);
            return fields;
        },
        copy);
}

} // namespace

std::string place_text(const glm::dvec3 &v, bool is_flat) {
    return is_flat ? "[" + shortest(v.x) + ", " + shortest(v.y) + "]" : array3(v);
}

std::string places_text(const std::vector<glm::dvec3> &points, bool is_flat) {
    Fields places;
    for (const glm::dvec3 &point : points)
        places.push_back(place_text(point, is_flat));
    return "[" + listed(places) + "]";
}

Fields shape_fields(const ShapeDesc &shape) {
    return fields_of_shape(shape);
}

Fields filter_fields(const ColliderDesc &collider) {
    Fields fields;
    if (collider.filter.layer != 0)
        fields.push_back("layer = " + std::to_string(collider.filter.layer));
    Fields ignored;
    for (int layer = 0; layer < max_layers; ++layer)
        if ((collider.filter.ignores >> static_cast<unsigned>(layer) & 1U) != 0)
            ignored.push_back(std::to_string(layer));
    if (!ignored.empty())
        fields.push_back("ignores = [" + listed(ignored) + "]");
    if (collider.sensor)
        fields.emplace_back("sensor = true");
    return fields;
}

std::string collider_text(const ColliderDesc &collider) {
    Fields fields = fields_of_shape(collider.shape);
    fields.push_back("position = " + array3(collider.position));
    fields.push_back("orientation = " + rotation(collider.orientation));
    if (!collider.material.empty())
        fields.push_back("material = " + string(collider.material));
    if (collider.density)
        fields.push_back("density = " + shortest(*collider.density));
    const Fields filter = filter_fields(collider);
    fields.insert(fields.end(), filter.begin(), filter.end());
    return "{ " + listed(fields) + " }";
}

std::string probe_shape_text(const ProbeShapeDesc &placed) {
    Fields fields = fields_of_shape(placed.shape);
    const KindInfo &info = kind_info(placed.shape);
    if (!placed.name.empty())
        fields.push_back("name = " + string(placed.name));
    if (!placed.parent.empty())
        fields.push_back("parent = " + string(placed.parent));
    if (info.placing != Placing::by_its_points)
        fields.push_back("position = " + place_text(placed.position, info.is_flat));
    if (info.placing == Placing::position_and_rotation)
        fields.push_back("orientation = " + rotation(placed.orientation));
    return "{ " + listed(fields) + " }";
}

} // namespace plumb::scene_file
