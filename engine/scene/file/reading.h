// The state of reading a scene file, and the readers of its tables. Not for users of the engine.
#pragma once

#include "engine/scene/file/names.h"
#include "engine/scene/file/shape.h"
#include "engine/scene/file/table.h"
#include "engine/scene/repeat.h"

#include <array>
#include <filesystem>
#include <map>

namespace plumb::scene_file {

// The copies of a repeated body, which have consecutive indices.
struct BodyGroup {
    std::size_t first = 0;
    std::size_t count = 0;
    bool is_complete = false; // false if the repeat had errors
};

struct Reading {
    Reading() = default;
    // For the file at `path`.
    Reading(const std::filesystem::path &path, const std::vector<std::string> &methods)
        : known_methods(methods.begin(), methods.end()), files(path.parent_path()) {
        scene.name = path.stem().string();
    }

    std::vector<std::string_view> known_methods;
    Report report;
    ShapeFiles files;
    SceneDesc scene;
    ScenePositions positions;
    Names materials;
    Names bodies;
    Names joints;
    Names attractors;
    Names particles;
    Names springs;
    Names cloths;
    Names expects;
    std::map<std::string, double> densities; // of materials
    std::map<std::string, std::size_t> bodies_by_name;
    std::map<std::string, std::size_t> particles_by_name;
    std::map<std::string, std::size_t> cloths_by_name;
    std::map<std::string, BodyGroup> groups; // by the name of the repeated body
    std::size_t triangles = 0;               // of all bodies
    std::size_t particle_count = 0;          // cloth included
    std::size_t spring_count = 0;            // cloth included
    int missing_bodies = 0;
    bool counts_may_differ = false; // drop expectations of missing copies
    bool said_too_many = false;
};

// A file's text, and its tables; empty, with a message, on failure.
std::optional<std::string> read_file(const std::filesystem::path &path,
                                     std::vector<SceneMessage> &messages);
std::optional<toml::table> parse_toml(std::string_view text, const std::string &path,
                                      std::vector<SceneMessage> &messages);

// The keys of a scene's top level.
inline constexpr std::array<std::string_view, 15> scene_keys{
    "title",    "description", "world",  "methods", "camera", "material", "body", "attractor",
    "particle", "cloth",       "spring", "joint",   "probe",  "expect",   "state"};

// Reads all tables of a scene, and reports every error.
void read_scene(Reading &reading, const Table &top);

// Each adds its table's contents to the scene, and reports every error.
void read_world(Reading &reading, const toml::table &source);
void read_methods(Reading &reading, const toml::table &source);
void read_camera(Reading &reading, const toml::table &source);
void read_material(Reading &reading, const toml::table &source);
void read_body(Reading &reading, const toml::table &source);
void read_joint(Reading &reading, const toml::table &source);
void read_attractor(Reading &reading, const toml::table &source);
void read_particle(Reading &reading, const toml::table &source);
void read_cloth(Reading &reading, const toml::table &source);
void read_spring(Reading &reading, const toml::table &source); // after everything it may name
void read_expect(Reading &reading, const toml::table &source);
void read_state(Reading &reading, const toml::table &source);

// Reads a table that holds only settings.
GivenSettings read_settings(Report &report, const toml::table &source, const std::string &title);

// A body's one shape or its list of shapes: at least one, usable even after an error. False if
// there was an error.
bool read_colliders(Reading &reading, const Table &table, BodyDesc &body);

// The name of an existing material; otherwise reports an error and returns the name as written, or
// empty.
std::string read_material_name(Reading &reading, const Table &table);

// How the body with that title is repeated; empty, with an error reported, if that is unclear.
std::optional<Repeat> read_repeat(Report &report, const toml::table &source,
                                  const std::string &title, const BodyDesc &body, bool has_shape);

// The index of the body named by `key`; empty, with an error reported, when there is none.
std::optional<std::size_t> find_body(Reading &reading, const Table &table, std::string_view key);

// Whether `count` more fit beside those present; if not, an error, once per file.
bool has_room_for(Reading &reading, std::size_t count, std::size_t limit, std::size_t present,
                  const char *what, const FilePosition &at);

} // namespace plumb::scene_file
