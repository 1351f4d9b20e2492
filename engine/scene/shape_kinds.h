// The shape kinds of scene files, one entry each: its name, who may have it, its fields. The
// reader, the writer, their error messages and the reference in scenes/README.md are generated from
// these. A kind without an entry does not compile. Not for users of the engine.
#pragma once

#include "engine/scene/probe_desc.h"

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb::scene_file {

inline constexpr std::size_t max_mesh_triangles = 100'000;
inline constexpr std::size_t max_shape_points = 10'000;      // of a hull given inline
inline constexpr std::size_t max_height_samples = 1'000'000; // of a height field

// For BodyDesc::locked.
inline constexpr std::array<std::string_view, 6> locked_names{
    "x", "y", "z", "rotation_x", "rotation_y", "rotation_z"};

// What places a probe's shape. Body shapes take both position and rotation.
enum class Placing { by_its_points, position, position_and_rotation };
// How a body with the shape can move.
enum class Moves { by_forces, as_told, never };

struct KindInfo {
    std::string_view name;
    std::string_view with_article;
    std::string_view size;  // for the error about another kind's size
    std::string_view about; // in the reference
    Placing placing = Placing::position_and_rotation;
    Moves moves = Moves::by_forces;
    bool is_flat = false;
};

// One of several ways to specify a shape, identified by its key.
template <typename Fields> struct Way {
    std::string_view key;
    bool is_chosen; // by an existing shape
    Fields fields;
};
template <typename Fields> Way(std::string_view, bool, Fields) -> Way<Fields>;

// Each has `info` and `fields(shape, visitor)`, which visits the fields in file order:
//   length, size, turn      a positive number, one per axis, an angle; all required
//   corners, cloud          a fixed number of points; any number of points
//   either                  one of several ways
//   file, word, whole       other fields; the current value is the default
//   surface, heights, parts
template <typename Shape> struct Kind;

template <> struct Kind<SphereDesc> {
    static constexpr KindInfo info{.name = "sphere",
                                   .with_article = "a sphere",
                                   .size = "its size is its radius",
                                   .about = "",
                                   .placing = Placing::position};
    static void fields(SphereDesc &s, auto &visitor) { visitor.length("radius", s.radius); }
};

template <> struct Kind<BoxDesc> {
    static constexpr KindInfo info{.name = "box",
                                   .with_article = "a box",
                                   .size = "its size is half_extents",
                                   .about = "`half_extents` is half of each side"};
    static void fields(BoxDesc &b, auto &visitor) { visitor.size("half_extents", b.half_extents); }
};

template <> struct Kind<AabbDesc> {
    static constexpr KindInfo info{.name = "aabb",
                                   .with_article = "an aabb",
                                   .size = "its size is half_extents",
                                   .about = "a box aligned with the world's axes",
                                   .placing = Placing::position};
    static void fields(AabbDesc &b, auto &visitor) { visitor.size("half_extents", b.half_extents); }
};

template <> struct Kind<CapsuleDesc> {
    static constexpr KindInfo info{
        .name = "capsule",
        .with_article = "a capsule",
        .size = "its size is half_height and radius",
        .about =
            "along its y axis, a cylinder of height 2 `half_height` with a hemisphere at each end"};
    static void fields(CapsuleDesc &c, auto &visitor) {
        visitor.length("half_height", c.half_height,
                       "half_height = metres, without the round ends");
        visitor.length("radius", c.radius);
    }
};

template <> struct Kind<CylinderDesc> {
    static constexpr KindInfo info{.name = "cylinder",
                                   .with_article = "a cylinder",
                                   .size = "its size is half_height and radius",
                                   .about = "along its y axis, of height 2 `half_height`"};
    static void fields(CylinderDesc &c, auto &visitor) {
        visitor.length("half_height", c.half_height);
        visitor.length("radius", c.radius);
    }
};

template <> struct Kind<PlaneDesc> {
    static constexpr KindInfo info{.name = "plane",
                                   .with_article = "a plane",
                                   .size = "it is infinite: the solid below y = 0 of its frame",
                                   .about = "everything below y = 0 of its frame is solid. Instead "
                                            "of a rotation it may have a unit `normal`",
                                   .moves = Moves::as_told};
    static void fields(PlaneDesc &, auto &) {}
};

template <> struct Kind<SegmentDesc> {
    static constexpr KindInfo info{.name = "segment",
                                   .with_article = "a segment",
                                   .size = "it is given by its points",
                                   .about = "two points in world coordinates",
                                   .placing = Placing::by_its_points};
    static void fields(SegmentDesc &s, auto &visitor) { visitor.corners("points", s.points); }
};

template <> struct Kind<TriangleDesc> {
    static constexpr KindInfo info{.name = "triangle",
                                   .with_article = "a triangle",
                                   .size = "it is given by its points",
                                   .about = "three points in world coordinates",
                                   .placing = Placing::by_its_points};
    static void fields(TriangleDesc &t, auto &visitor) { visitor.corners("points", t.points); }
};

template <> struct Kind<HullDesc> {
    static constexpr KindInfo info{
        .name = "hull",
        .with_article = "a hull",
        .size = "its size is that of its points",
        .about = "the convex hull of four or more points, or of the vertices of a Wavefront OBJ "
                 "file, times `scale`"};
    static void fields(HullDesc &h, auto &visitor) {
        visitor.either(R"(points = [[x, y, z], ...], or file = "name.obj")",
                       Way{"points", !h.file, [&] { visitor.cloud("points", h.points); }},
                       Way{"file", h.file.has_value(), [&] {
                               if (!h.file)
                                   h.file.emplace();
                               visitor.file(*h.file);
                           }});
    }
};

inline constexpr std::array<std::string_view, 4> mesh_model_names{"ball", "torus", "knot", "bowl"};
inline constexpr std::array<std::string_view, 3> mesh_side_names{"one", "both", "solid"};
inline constexpr std::array<std::string_view, 2> field_side_names{"one", "solid"};

template <> struct Kind<MeshDesc> {
    static constexpr KindInfo info{
        .name = "mesh",
        .with_article = "a mesh",
        .size = "its size is that of its model, file or vertices",
        .about =
            "triangles: as given, counter-clockwise seen from the front; or those of a Wavefront "
            "OBJ file, times `scale`; or a model with these `half_extents`. Bodies collide with "
            "its front side only, with both `sides`, or with the solid that a closed mesh "
            "encloses, which pushes out what is inside. At most 100,000 triangles",
        .moves = Moves::never};
    static void fields(MeshDesc &m, auto &visitor) {
        visitor.either(
            R"(model = "ball", "torus", "knot" or "bowl", or file = "name.obj", or vertices)",
            Way{"model", std::holds_alternative<MeshModel>(m.source),
                [&] {
                    if (!std::holds_alternative<MeshModel>(m.source))
                        m.source.template emplace<MeshModel>();
                    auto &model = std::get<MeshModel>(m.source);
                    visitor.word("model", model.kind, mesh_model_names, false);
                    visitor.size("half_extents", model.half_extents);
                    visitor.whole("detail", model.detail, 3, 64);
                }},
            Way{"file", std::holds_alternative<ShapeFile>(m.source),
                [&] {
                    if (!std::holds_alternative<ShapeFile>(m.source))
                        m.source.template emplace<ShapeFile>();
                    visitor.file(std::get<ShapeFile>(m.source));
                }},
            Way{"vertices", std::holds_alternative<std::monostate>(m.source),
                [&] { visitor.surface("vertices", "triangles", m.data); }});
        visitor.word("sides", m.sides, mesh_side_names, true);
    }
};

template <> struct Kind<HeightFieldDesc> {
    static constexpr KindInfo info{
        .name = "height_field",
        .with_article = "a height field",
        .size = "its size is half_extents, or that of its heights",
        .about = "ground centred on its position: rows of `heights` along x, one after another "
                 "along z, `spacing` apart; or hills within `half_extents`, with `detail` squares "
                 "along x. Bodies collide with its top side only, or it is solid below, as deep as "
                 "it is long, and pushes up what is inside",
        .placing = Placing::position,
        .moves = Moves::never};
    static void fields(HeightFieldDesc &f, auto &visitor) {
        visitor.either("heights = [[y, y, ...], ...], or half_extents = [x, y, z] of hills",
                       Way{"half_extents", f.hills.has_value(),
                           [&] {
                               if (!f.hills)
                                   f.hills.emplace();
                               visitor.size("half_extents", f.hills->half_extents);
                               visitor.whole("detail", f.hills->detail, 3, 64);
                           }},
                       Way{"heights", !f.hills, [&] {
                               visitor.heights("heights", f);
                               visitor.length("spacing", f.spacing);
                           }});
        visitor.word("sides", f.is_solid, field_side_names, true);
    }
};

template <> struct Kind<FlatSegmentDesc> {
    static constexpr KindInfo info{.name = "flat_segment",
                                   .with_article = "a flat segment",
                                   .size = "it is given by its points",
                                   .about = "two points `[x, y]`",
                                   .placing = Placing::by_its_points,
                                   .is_flat = true};
    static void fields(FlatSegmentDesc &s, auto &visitor) { visitor.corners("points", s.points); }
};

template <> struct Kind<CircleDesc> {
    static constexpr KindInfo info{.name = "circle",
                                   .with_article = "a circle",
                                   .size = "its size is its radius",
                                   .about = "",
                                   .placing = Placing::position,
                                   .is_flat = true};
    static void fields(CircleDesc &c, auto &visitor) { visitor.length("radius", c.radius); }
};

template <> struct Kind<RectangleDesc> {
    static constexpr KindInfo info{.name = "rectangle",
                                   .with_article = "a rectangle",
                                   .size = "its size is half_extents",
                                   .about = "axis-aligned",
                                   .placing = Placing::position,
                                   .is_flat = true};
    static void fields(RectangleDesc &r, auto &visitor) {
        visitor.size("half_extents", r.half_extents);
    }
};

template <> struct Kind<OrientedRectangleDesc> {
    static constexpr KindInfo info{.name = "oriented_rectangle",
                                   .with_article = "an oriented rectangle",
                                   .size = "its size is half_extents",
                                   .about = "rotated counter-clockwise",
                                   .placing = Placing::position,
                                   .is_flat = true};
    static void fields(OrientedRectangleDesc &r, auto &visitor) {
        visitor.size("half_extents", r.half_extents);
        visitor.turn("angle", r.angle);
    }
};

template <> struct Kind<FlatCompoundDesc> {
    static constexpr KindInfo info{.name = "compound",
                                   .with_article = "a compound",
                                   .size = "its size is that of its parts",
                                   .about = "circles, rectangles and oriented rectangles, each "
                                            "with a `position` relative to the compound's",
                                   .placing = Placing::position,
                                   .is_flat = true};
    static void fields(FlatCompoundDesc &c, auto &visitor) { visitor.parts("parts", c.parts); }
};

// Names of the kinds in a shape variant, in its order.
template <typename Shape, std::size_t... i>
std::vector<std::string_view> kind_names(std::index_sequence<i...>) {
    return {Kind<std::variant_alternative_t<i, Shape>>::info.name...};
}
template <typename Shape> const std::vector<std::string_view> &kind_names() {
    static const std::vector<std::string_view> names =
        kind_names<Shape>(std::make_index_sequence<std::variant_size_v<Shape>>());
    return names;
}

// A default shape of the kind with that index.
template <typename Shape, std::size_t i = 0> Shape shape_of_kind(std::size_t index) {
    if constexpr (i + 1 < std::variant_size_v<Shape>)
        if (index != i)
            return shape_of_kind<Shape, i + 1>(index);
    return Shape(std::in_place_index<i>);
}

template <typename Shape> const KindInfo &kind_info(const Shape &shape) {
    return std::visit([]<typename S>(const S &) -> const KindInfo & { return Kind<S>::info; },
                      shape);
}

} // namespace plumb::scene_file
