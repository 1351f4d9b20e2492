// A table of a scene file, with getters for its values. Not for users of the engine.
#pragma once

#include "engine/scene/file/bounds.h"
#include "engine/scene/file/report.h"
#include "engine/scene/scene_desc.h"

#include <array>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Compiled once, in table.cpp, regardless of the build system; reports errors as values.
#undef TOML_HEADER_ONLY
#undef TOML_SHARED_LIB
#define TOML_HEADER_ONLY 0
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#define TOML_FLOAT_CHARCONV 1 // exact for every double, subnormal ones too
// toml++ 3.3 asserts (and in release builds lets the compiler assume) that a key follows "[" before
// checking for it and reporting an error: "[.a]" would end the program. With both disabled it only
// checks.
#undef NDEBUG
#define TOML_ASSERT(expression) static_cast<void>(0)
#include <toml++/toml.h>

namespace plumb::scene_file {

inline constexpr double degree = std::numbers::pi / 180;

using Words = std::span<const std::string_view>;

std::string_view type_name(const toml::node &node); // with article

FilePosition position_of(const toml::source_region &region);
FilePosition position_of(const toml::node &node);

// One table of the file. Each getter returns empty when the key is absent, or, with an error
// reported, when its value is invalid.
class Table {
  public:
    // Reports every key that is not among `keys`. `title` names the table in messages.
    Table(Report &report, const toml::table &table, std::string title, Words keys);

    const std::string &title() const { return title_; }
    FilePosition position() const { return position_of(table_); }
    bool has(std::string_view key) const { return table_.contains(key); }
    const toml::node *node(std::string_view key) const { return table_.get(key); }

    // Of the value, or of the table when the key is absent.
    FilePosition position(std::string_view key) const;

    // Of the key, or of the table when the key is absent.
    FilePosition key_position(std::string_view key) const;

    void error(std::string_view key, std::string what, std::string suggestion = {}) const;

    // Whether the key is present; reports an error if not.
    bool require(std::string_view key, std::string suggestion) const;

    // Reports those of the keys that are present, as they do not belong here.
    void refuse(std::initializer_list<std::string_view> keys, const std::string &what,
                const std::string &suggestion) const;

    // Which one of these keys is present. Reports an error for each further one and, if `required`,
    // when there is none. Empty unless exactly one is present.
    std::string_view one_of(std::initializer_list<std::string_view> keys, bool required,
                            const std::string &suggestion) const;

    std::optional<double> number(std::string_view key, const Bounds &bounds) const;

    std::optional<std::int64_t> integer(std::string_view key, std::int64_t min,
                                        std::int64_t max) const;

    std::optional<bool> boolean(std::string_view key) const;

    std::optional<std::string> string(std::string_view key) const;

    // Whole numbers from 0 to 2^64 - 1; strings for those that TOML integers cannot hold.
    std::optional<std::uint64_t> natural(std::string_view key) const;

    // The index of the word; if it is none of them, an error suggests the nearest.
    std::optional<std::size_t> choice(std::string_view key, Words words) const;

    template <std::size_t count>
    std::optional<std::array<double, count>> numbers(std::string_view key,
                                                     const Bounds &bounds) const {
        const toml::node *value = node(key);
        return value ? numbers<count>(*value, std::string(key), bounds) : std::nullopt;
    }

    template <std::size_t count>
    std::optional<std::array<double, count>>
    numbers(const toml::node &value, const std::string &name, const Bounds &bounds) const {
        const toml::array *elements = value.as_array();
        if (!elements || elements->size() != count) {
            const std::string what =
                elements ? name + " has " + std::to_string(elements->size()) + " elements"
                         : name + " is " + std::string(type_name(value));
            report_.error(position_of(value), what,
                          "it must be an array of " + std::to_string(count) + " numbers");
            return std::nullopt;
        }
        std::array<double, count> result{};
        bool complete = true;
        for (std::size_t i = 0; i < count; ++i) {
            const std::optional<double> element =
                number(*elements->get(i), name + "[" + std::to_string(i) + "]", bounds);
            complete = complete && element;
            result[i] = element.value_or(0);
        }
        return complete ? std::optional(result) : std::nullopt;
    }

    std::optional<glm::dvec3> vector(std::string_view key, const Bounds &bounds) const;

    std::optional<glm::dvec3> unit_vector(std::string_view key) const;

    // [w, x, y, z]; kept bit for bit if already of unit length.
    std::optional<glm::dquat> unit_quaternion(std::string_view key) const;

    // [r, g, b] from 0 to 1, or "#rrggbb".
    std::optional<glm::vec3> colour(std::string_view key) const;

    // An angle in radians, from `key`, or from `key`_deg in degrees, but not both. The bounds are
    // in degrees.
    std::optional<double> angle(std::string_view key, const Bounds &degrees) const;

    std::optional<double> number(const toml::node &value, const std::string &name,
                                 const Bounds &bounds) const;

    std::optional<std::int64_t> integer(const toml::node &value, const std::string &name,
                                        std::int64_t min, std::int64_t max) const;

    void wrong_type(const toml::node &value, const std::string &name,
                    std::string_view wanted) const;

  private:
    void not_unit(std::string_view key, double length, const std::vector<double> &v) const;

    Report &report_;
    const toml::table &table_;
    std::string title_;
};

// The table at that key; null, with an error reported, when it is something else.
const toml::table *table_at(Report &report, const Table &parent, std::string_view key,
                            const std::string &example = {});

// Reads each table of an array of tables. `path` is the text between the double brackets.
template <typename Read>
void for_each(Report &report, const Table &parent, std::string_view key, Read &&read,
              std::string_view path = {}) {
    const toml::node *node = parent.node(key);
    if (!node)
        return;
    const std::string suggestion =
        "write [[" + std::string(path.empty() ? key : path) + "]] for each " + std::string(key);
    const toml::array *array = node->as_array();
    if (!array) {
        report.error(parent.key_position(key),
                     std::string(key) + " is " + std::string(type_name(*node)), suggestion);
        return;
    }
    for (const toml::node &element : *array) {
        if (const toml::table *table = element.as_table())
            read(*table);
        else
            report.error(position_of(element),
                         std::string(key) + " holds " + std::string(type_name(element)),
                         suggestion);
    }
}

// Whether a joint's or spring's end is the world, as it also is without the key.
bool is_world(const Table &table, std::string_view key);

// rotation_deg, or axis and angle_deg, or orientation, at most one of them; no rotation by default.
glm::dquat read_rotation(Report &report, const Table &table);

} // namespace plumb::scene_file
