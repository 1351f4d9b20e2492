#include "engine/scene/obj_file.h"

#include "engine/math/predicates.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>

#include <glm/geometric.hpp>

#define TINYOBJLOADER_USE_DOUBLE
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

namespace plumb {

namespace {

// An error on a line; thrown and caught in this file only.
struct Refusal {
    std::size_t line;
    std::string what;       // was wrong
    std::string suggestion; // what would be right
};

template <typename... Parts> std::string text(const Parts &...parts) {
    std::ostringstream out;
    (out << ... << parts);
    return out.str();
}

// A token made safe to print on one line of a terminal.
std::string quoted(std::string_view token) {
    constexpr std::size_t most = 40;
    std::string shown = "'";
    for (const char c : token.substr(0, most))
        shown += c >= ' ' && c <= '~' ? c : '?';
    return shown + (token.size() > most ? "...'" : "'");
}

std::string read_all(std::istream &in) {
    std::string all;
    std::string block(1U << 16U, '\0');
    while (in) {
        in.read(block.data(), static_cast<std::streamsize>(block.size()));
        all.append(block, 0, static_cast<std::size_t>(in.gcount()));
        if (all.size() > max_obj_bytes)
            throw Refusal{0, "the file is too large", text("at most ", max_obj_bytes, " bytes")};
    }
    if (in.bad())
        throw Refusal{0, "the file cannot be read", "check that it is a readable file"};
    return all;
}

std::string_view next_token(std::string_view &line) {
    const std::size_t first = std::min(line.find_first_not_of(" \t"), line.size());
    line.remove_prefix(first);
    const std::string_view token = line.substr(0, line.find_first_of(" \t"));
    line.remove_prefix(token.size());
    return token;
}

double read_coordinate(std::string_view token, std::size_t line) {
    if (token.empty())
        throw Refusal{line, "a vertex with fewer than three numbers", "v x y z"};
    std::string_view digits = token;
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-')
        digits.remove_prefix(1);
    double value = 0;
    const auto [end, problem] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (problem == std::errc::result_out_of_range)
        throw Refusal{line, "a number out of the range of double: " + quoted(token),
                      text("coordinates from ", -max_obj_coordinate, " to ", max_obj_coordinate)};
    if (problem != std::errc() || end != digits.data() + digits.size())
        throw Refusal{line, "not a number: " + quoted(token), "v x y z, such as v 0.5 -1 2e-3"};
    if (!(std::abs(value) <= max_obj_coordinate))
        throw Refusal{line, "a coordinate that is not finite or too large: " + quoted(token),
                      text("coordinates from ", -max_obj_coordinate, " to ", max_obj_coordinate)};
    return value;
}

// An index, optionally followed by others after slashes, each short enough not to overflow an int.
bool is_corner(std::string_view token) {
    for (int part = 0; part < 3; ++part) {
        if (token.starts_with('-'))
            token.remove_prefix(1);
        const std::size_t digits = std::min(token.find_first_not_of("0123456789"), token.size());
        const bool may_be_missing = part == 1;
        if (digits > 9 || (digits == 0 && !may_be_missing))
            return false;
        token.remove_prefix(digits);
        if (token.empty())
            return digits > 0;
        if (token[0] != '/')
            return false;
        token.remove_prefix(1);
    }
    return false;
}

void check_face(std::string_view rest, std::size_t line) {
    std::size_t corners = 0;
    for (std::string_view token = next_token(rest); !token.empty(); token = next_token(rest)) {
        if (token[0] == '#')
            break;
        if (!is_corner(token))
            throw Refusal{line, "not a corner of a face: " + quoted(token),
                          "a vertex index, such as 7, 7/1, 7//3, 7/1/3 or -1"};
        ++corners;
    }
    if (corners < 3)
        throw Refusal{line, text("a face with ", corners, " corners"), "three or more"};
    if (corners > max_obj_polygon_corners)
        throw Refusal{line, text("a face with ", corners, " corners"),
                      text(max_obj_polygon_corners, " at most; split it up")};
}

// The relevant lines of a file and their contents.
struct ObjLines {
    std::vector<glm::dvec3> vertices;
    std::vector<std::size_t> face_lines;      // the number of each line with a face
    std::vector<std::size_t> vertices_before; // each face
    std::string faces;                        // those lines, for tinyobjloader
};

// tinyobjloader reads garbage as zero, overflows on long numbers, and is off in the last digits. So
// it gets only lines that were checked here, and vertices are read here.
ObjLines checked_lines(std::string_view file) {
    ObjLines lines;
    std::size_t number = 0;
    while (!file.empty()) {
        ++number;
        const std::size_t end = std::min(file.find_first_of("\r\n"), file.size());
        std::string_view line = file.substr(0, end);
        const bool is_pair = file.substr(end).starts_with("\r\n");
        file.remove_prefix(std::min(end + (is_pair ? 2 : 1), file.size()));

        if (line.size() > max_obj_line_bytes)
            throw Refusal{number, text("a line of ", line.size(), " bytes"),
                          text(max_obj_line_bytes, " at most")};
        if (line.find('\0') != std::string_view::npos)
            throw Refusal{number, "a zero byte", "a text file"};
        const std::string_view whole = line;
        const std::string_view keyword = next_token(line);
        if (keyword == "v") {
            if (lines.vertices.size() == max_obj_vertices)
                throw Refusal{number, "too many vertices", text(max_obj_vertices, " at most")};
            glm::dvec3 vertex{0};
            for (int i = 0; i < 3; ++i)
                vertex[i] = read_coordinate(next_token(line), number);
            lines.vertices.push_back(vertex);
        } else if (keyword == "f") {
            check_face(line, number);
            lines.face_lines.push_back(number);
            lines.vertices_before.push_back(lines.vertices.size());
            lines.faces.append(whole.substr(0, whole.find('#'))) += '\n';
        }
    }
    if (lines.face_lines.empty())
        throw Refusal{number, "the file has no faces", "lines such as v 0 0 0 and f 1 2 3"};
    return lines;
}

struct Flat {
    double x, y;
};

// The sign of (b - a) x (c - a): +1 when a, b, c turn counter-clockwise. Like orient2d
// (predicates.h), whose points are in the engine's precision.
int turn(const Flat &a, const Flat &b, const Flat &c) {
    const double left = (b.x - a.x) * (c.y - a.y);
    const double right = (b.y - a.y) * (c.x - a.x);
    const double bound =
        (3.0 + 16.0 * exact::unit) * exact::unit * (std::abs(left) + std::abs(right));
    if (left - right > bound)
        return 1;
    if (left - right < -bound)
        return -1;
    return exact::cross_sign({{b.x, a.x}, {b.y, a.y}}, {{c.x, a.x}, {c.y, a.y}});
}

bool is_same(const Flat &a, const Flat &b) {
    return a.x == b.x && a.y == b.y;
}

// Triangulates polygons.
class Cutter {
  public:
    Cutter(const std::vector<glm::dvec3> &vertices,
           std::vector<std::array<std::uint32_t, 3>> &triangles)
        : vertices_(vertices), triangles_(triangles) {}

    void cut(const std::vector<std::uint32_t> &corners, std::size_t line) {
        const std::size_t count = corners.size();
        if (triangles_.size() + count - 2 > max_obj_triangles)
            throw Refusal{line, "too many triangles", text(max_obj_triangles, " at most")};
        if (count == 3 || is_on_a_line(corners)) {
            for (std::size_t i = 2; i < count; ++i)
                triangles_.push_back({corners[0], corners[i - 1], corners[i]});
            return;
        }
        if (!flatten(corners))
            refuse_crossing(count, line);
        clip_ears(corners, line);
    }

  private:
    [[noreturn]] static void refuse_crossing(std::size_t count, std::size_t line) {
        throw Refusal{line,
                      text("a face of ", count, " corners whose outline crosses or touches itself"),
                      "split it into triangles"};
    }

    // Bound on the relative error of a sum of `count` products of differences, as a fraction of
    // their magnitudes: three roundings per product, one per addition.
    static double roundings(std::size_t count) {
        return static_cast<double>(count + 4) * exact::unit;
    }

    // The magnitudes of the products in cross(a, b).
    static glm::dvec3 cross_magnitudes(const glm::dvec3 &a, const glm::dvec3 &b) {
        return {std::abs(a.y * b.z) + std::abs(a.z * b.y),
                std::abs(a.z * b.x) + std::abs(a.x * b.z),
                std::abs(a.x * b.y) + std::abs(a.y * b.x)};
    }

    bool is_on_a_line(const std::vector<std::uint32_t> &corners) const {
        const glm::dvec3 first = vertices_[corners[0]];
        glm::dvec3 farthest{0};
        for (const std::uint32_t corner : corners) {
            const glm::dvec3 here = vertices_[corner] - first;
            if (glm::dot(here, here) > glm::dot(farthest, farthest))
                farthest = here;
        }
        for (const std::uint32_t corner : corners) {
            const glm::dvec3 here = vertices_[corner] - first;
            const glm::dvec3 across = glm::cross(farthest, here);
            const glm::dvec3 sizes = cross_magnitudes(farthest, here);
            for (int i = 0; i < 3; ++i)
                if (std::abs(across[i]) > roundings(corners.size()) * sizes[i])
                    return false;
        }
        return true;
    }

    // Projects the corners along an axis, counter-clockwise; false when no area is left.
    bool flatten(const std::vector<std::uint32_t> &corners) {
        // Newell's normal (Sutherland, Sproull, Schumacker 1974), twice the projected area along
        // each axis, relative to the first corner to reduce cancellation.
        const glm::dvec3 first = vertices_[corners[0]];
        glm::dvec3 normal{0};
        glm::dvec3 sum{0};
        for (std::size_t i = 2; i < corners.size(); ++i) {
            const glm::dvec3 a = vertices_[corners[i - 1]] - first;
            const glm::dvec3 b = vertices_[corners[i]] - first;
            normal += glm::cross(a, b);
            sum += cross_magnitudes(a, b);
        }
        int axis = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(normal[i]) > std::abs(normal[axis]))
                axis = i;
        if (!(std::abs(normal[axis]) > roundings(corners.size()) * sum[axis]))
            return false;
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        flat_.clear();
        for (const std::uint32_t corner : corners) {
            const glm::dvec3 &p = vertices_[corner];
            flat_.push_back(normal[axis] > 0 ? Flat{p[u], p[v]} : Flat{p[v], p[u]});
        }
        return true;
    }

    void clip_ears(const std::vector<std::uint32_t> &corners, std::size_t line) {
        const std::size_t count = corners.size();
        next_.resize(count);
        previous_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            next_[i] = (i + 1) % count;
            previous_[i] = (i + count - 1) % count;
        }
        std::size_t left = count;
        std::size_t tried = 0;
        std::size_t tip = 1; // so that a convex polygon becomes a fan around its first corner
        while (left > 3) {
            const std::size_t a = previous_[tip];
            const std::size_t c = next_[tip];
            if (is_ear(tip, line)) {
                triangles_.push_back({corners[a], corners[tip], corners[c]});
                next_[a] = c;
                previous_[c] = a;
                --left;
                tried = 0;
            } else if (++tried == left) {
                refuse_crossing(count, line);
            }
            tip = c;
        }
        triangles_.push_back({corners[previous_[tip]], corners[tip], corners[next_[tip]]});
    }

    // Whether the corner can be clipped: it is convex, and no other corner is inside the triangle.
    // Convex corners need no test, as the deepest corner inside is never convex.
    bool is_ear(std::size_t tip, std::size_t line) {
        const std::size_t first = previous_[tip];
        const std::size_t last = next_[tip];
        const Flat &a = flat_[first];
        const Flat &b = flat_[tip];
        const Flat &c = flat_[last];
        if (turn(a, b, c) <= 0)
            return false;
        for (std::size_t i = next_[last]; i != first; i = next_[i]) {
            if (++tests_ > max_obj_corner_tests)
                throw Refusal{line, "polygons that take too long to triangulate", "use triangles"};
            const Flat &p = flat_[i];
            if (turn(a, b, p) < 0 || turn(b, c, p) < 0 || turn(c, a, p) < 0)
                continue;
            if (turn(flat_[previous_[i]], p, flat_[next_[i]]) > 0)
                continue;
            // An outline that returns to its own corner along a slit does not cross itself.
            if (!is_same(p, a) && !is_same(p, b) && !is_same(p, c))
                return false;
        }
        return true;
    }

    const std::vector<glm::dvec3> &vertices_;
    std::vector<std::array<std::uint32_t, 3>> &triangles_;
    std::vector<Flat> flat_;
    std::vector<std::size_t> next_, previous_;
    std::size_t tests_ = 0;
};

// tinyobjloader's face callback.
struct Faces {
    const ObjLines &lines;
    Cutter cutter;
    std::size_t face = 0;
    std::vector<std::uint32_t> corners;

    void add(const tinyobj::index_t *indices, int count) {
        const std::size_t line = lines.face_lines.at(face);
        const auto before = static_cast<std::int64_t>(lines.vertices_before.at(face));
        ++face;
        corners.clear();
        for (int i = 0; i < count; ++i) {
            const std::int64_t given = indices[i].vertex_index;
            const std::int64_t index = given > 0 ? given - 1 : before + given;
            if (given == 0)
                throw Refusal{line, "a face with vertex 0", "the first vertex is 1, the last -1"};
            if (index < 0 || index >= static_cast<std::int64_t>(lines.vertices.size()))
                throw Refusal{line, text("a face with vertex ", given),
                              given > 0 ? text("the file has ", lines.vertices.size(), " vertices")
                                        : text("there are ", before, " vertices before this line")};
            corners.push_back(static_cast<std::uint32_t>(index));
        }
        cutter.cut(corners, line);
    }
};

ObjMesh read_mesh(std::istream &in) {
    const std::string file = read_all(in);
    ObjLines lines = checked_lines(file);
    ObjMesh mesh;
    Faces faces{lines, Cutter(lines.vertices, mesh.triangles), 0, {}};
    tinyobj::callback_t callback;
    callback.index_cb = [](void *user, tinyobj::index_t *indices, int count) {
        static_cast<Faces *>(user)->add(indices, count);
    };
    std::istringstream text(std::move(lines.faces));
    std::string warning, error;
    if (!tinyobj::LoadObjWithCallback(text, callback, &faces, nullptr, &warning, &error) ||
        faces.face != lines.face_lines.size())
        throw Refusal{0, "the faces cannot be read", error};
    mesh.vertices = std::move(lines.vertices);
    return mesh;
}

} // namespace

ObjResult read_obj(std::istream &in, const std::string &name) {
    ObjResult result;
    try {
        result.mesh = read_mesh(in);
    } catch (const Refusal &refusal) {
        result.error = text(name, ':', refusal.line, ": ", refusal.what, "; ", refusal.suggestion);
    }
    return result;
}

} // namespace plumb
