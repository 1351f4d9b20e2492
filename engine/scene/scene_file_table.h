// The tables of a scene file: what its readers have in common. Not for users of the engine.
#pragma once

#include "engine/scene/scene_file.h"
#include "engine/scene/scene_file_number.h"
#include "engine/scene/scene_file_spelling.h"
#include "engine/scene/scene_file_warnings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/gtc/quaternion.hpp>

// Compiled into the readers alone, whatever the build system says, and reporting errors as values.
#undef TOML_HEADER_ONLY
#undef TOML_SHARED_LIB
#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#define TOML_FLOAT_CHARCONV 1 // exact for every double, subnormal ones too
// toml++ 3.3 asserts (and in release builds lets the compiler assume) that a key begins after "[",
// before it looks and reports that none does: "[.a]" would end the program. With both off it only
// looks.
#undef NDEBUG
#define TOML_ASSERT(expression) static_cast<void>(0)
#include <toml++/toml.h>

namespace plumb::scene_file {

inline constexpr double degree = std::numbers::pi / 180;
inline constexpr double exactly_unit = 1e-6; // within this, a unit vector is taken as it is
inline constexpr double nearly_unit =
    1e-3; // within this, it is taken as rounded by hand, and normalised

using Words = std::span<const std::string_view>;

// What a number may be, and how to say so.
struct Bounds {
    double min;
    double max;
    std::string_view text;
};
inline constexpr double huge = max_scene_magnitude;
inline constexpr Bounds finite{std::numeric_limits<double>::lowest(),
                               std::numeric_limits<double>::max(), "a finite number"};
inline constexpr Bounds moderate{-huge, huge, "a number between -1e9 and 1e9"};
inline constexpr Bounds positive{1 / huge, huge, "a positive number, from 1e-9 to 1e9"};
inline constexpr Bounds not_negative{0, huge, "a number from 0 to 1e9"};
inline constexpr Bounds fraction{0, 1, "a number from 0 to 1"};
inline constexpr Bounds above_zero{std::numeric_limits<double>::denorm_min(),
                                   std::numeric_limits<double>::max(), "a number above 0"};

inline std::string in_quotes(std::string_view name) {
    return '"' + std::string(name) + '"';
}

inline std::string_view type_name(const toml::node &node) {
    switch (node.type()) {
    case toml::node_type::table:
        return "a table";
    case toml::node_type::array:
        return "an array";
    case toml::node_type::string:
        return "a string";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
        return "a number";
    case toml::node_type::boolean:
        return "true or false";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time:
        return "a date or time";
    case toml::node_type::none:
        break;
    }
    return "nothing";
}

inline FilePosition position_of(const toml::source_region &region) {
    return {std::max<std::size_t>(1, region.begin.line),
            std::max<std::size_t>(1, region.begin.column)};
}
inline FilePosition position_of(const toml::node &node) {
    return position_of(node.source());
}

class Report {
  public:
    void error(const FilePosition &at, std::string what, std::string suggestion = {}) {
        add(SceneMessage::Severity::error, at, std::move(what), std::move(suggestion));
        ++error_count_;
    }
    void warning(const FilePosition &at, std::string what, std::string suggestion = {}) {
        add(SceneMessage::Severity::warning, at, std::move(what), std::move(suggestion));
    }
    void add(SceneMessage message) { messages_.push_back(std::move(message)); }

    std::size_t error_count() const { return error_count_; }

    std::vector<SceneMessage> in_file_order() {
        std::stable_sort(messages_.begin(), messages_.end(),
                         [](const SceneMessage &a, const SceneMessage &b) {
                             return a.line != b.line ? a.line < b.line : a.column < b.column;
                         });
        return std::move(messages_);
    }

  private:
    void add(SceneMessage::Severity severity, const FilePosition &at, std::string what,
             std::string suggestion) {
        messages_.push_back({severity, at.line, at.column, std::move(what), std::move(suggestion)});
    }

    std::vector<SceneMessage> messages_;
    std::size_t error_count_ = 0;
};

// One table of the file. Each getter gives nothing when the key is absent, and also, having
// reported it, when its value is not what it should be.
class Table {
  public:
    // Reports every key that is not among `keys`. `title` is what messages call the table.
    Table(Report &report, const toml::table &table, std::string title, Words keys)
        : report_(report), table_(table), title_(std::move(title)) {
        for (const auto &[key, value] : table)
            if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
                report.error(position_of(key.source()),
                             "unknown key " + in_quotes(key.str()) + " in " + title_,
                             misplaced(key.str(), title_).value_or(did_you_mean(key.str(), keys)));
    }

    const std::string &title() const { return title_; }
    FilePosition position() const { return position_of(table_); }
    bool has(std::string_view key) const { return table_.contains(key); }
    const toml::node *node(std::string_view key) const { return table_.get(key); }

    // Of the value, or of the table when the key is absent.
    FilePosition position(std::string_view key) const {
        const toml::node *value = node(key);
        return value ? position_of(*value) : position();
    }

    // Of the key, or of the table when the key is absent.
    FilePosition key_position(std::string_view key) const {
        const auto found = table_.find(key);
        return found == table_.end() ? position() : position_of(found->first.source());
    }

    void error(std::string_view key, std::string what, std::string suggestion = {}) const {
        report_.error(position(key), std::move(what), std::move(suggestion));
    }

    // Whether the key is there; an error when not.
    bool require(std::string_view key, std::string suggestion) const {
        if (has(key))
            return true;
        report_.error(position(), title_ + " has no " + std::string(key), std::move(suggestion));
        return false;
    }

    // Reports the keys that have no business here.
    void refuse(std::initializer_list<std::string_view> keys, const std::string &what,
                const std::string &suggestion) const {
        for (const std::string_view key : keys)
            if (has(key))
                report_.error(key_position(key), what + " has no " + std::string(key), suggestion);
    }

    // The one key of these that is there; an error at each further one, and, if `required`, when
    // there is none. Empty when not exactly one.
    std::string_view one_of(std::initializer_list<std::string_view> keys, bool required,
                            const std::string &suggestion) const {
        std::string_view chosen;
        bool several = false;
        for (const std::string_view key : keys) {
            if (!has(key))
                continue;
            if (!chosen.empty()) {
                report_.error(key_position(key),
                              title_ + " has both " + std::string(chosen) + " and " +
                                  std::string(key),
                              "keep one of them");
                several = true;
            } else {
                chosen = key;
            }
        }
        if (chosen.empty() && required) {
            std::string list;
            for (const std::string_view key : keys)
                list += (list.empty() ? "" : ", ") + std::string(key);
            report_.error(position(), title_ + " has none of " + list, suggestion);
        }
        return several ? std::string_view{} : chosen;
    }

    std::optional<double> number(std::string_view key, const Bounds &bounds) const {
        const toml::node *value = node(key);
        return value ? number(*value, std::string(key), bounds) : std::nullopt;
    }

    std::optional<std::int64_t> integer(std::string_view key, std::int64_t min,
                                        std::int64_t max) const {
        const toml::node *value = node(key);
        return value ? integer(*value, std::string(key), min, max) : std::nullopt;
    }

    std::optional<bool> boolean(std::string_view key) const {
        const toml::node *value = node(key);
        if (!value)
            return std::nullopt;
        if (const auto *boolean = value->as_boolean())
            return boolean->get();
        wrong_type(*value, std::string(key), "true or false");
        return std::nullopt;
    }

    std::optional<std::string> string(std::string_view key) const {
        const toml::node *value = node(key);
        if (!value)
            return std::nullopt;
        if (const auto *string = value->as_string())
            return string->get();
        wrong_type(*value, std::string(key), "a string in quotes");
        return std::nullopt;
    }

    // Whole numbers from 0 to 2^64 - 1; those that TOML's integers cannot hold as strings.
    std::optional<std::uint64_t> natural(std::string_view key) const {
        const std::string_view wanted =
            "a whole number from 0 to 2^64 - 1 (in quotes from 2^63 on)";
        const toml::node *value = node(key);
        if (!value)
            return std::nullopt;
        if (const auto *integer = value->as_integer(); integer && integer->get() >= 0)
            return static_cast<std::uint64_t>(integer->get());
        if (const auto *string = value->as_string()) {
            const std::string &text = string->get();
            std::uint64_t number = 0;
            const auto [end, failure] =
                std::from_chars(text.data(), text.data() + text.size(), number);
            if (failure == std::errc{} && end == text.data() + text.size())
                return number;
        }
        report_.error(position_of(*value), std::string(key) + " is not a natural number",
                      "it must be " + std::string(wanted));
        return std::nullopt;
    }

    // The index of the word; an error that suggests the nearest when it is none of them.
    std::optional<std::size_t> choice(std::string_view key, Words words) const {
        const std::optional<std::string> word = string(key);
        if (!word)
            return std::nullopt;
        const auto found = std::find(words.begin(), words.end(), *word);
        if (found != words.end())
            return static_cast<std::size_t>(found - words.begin());
        error(key, "unknown " + std::string(key) + " " + in_quotes(*word),
              did_you_mean(*word, words));
        return std::nullopt;
    }

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

    std::optional<glm::dvec3> vector(std::string_view key, const Bounds &bounds) const {
        const auto n = numbers<3>(key, bounds);
        return n ? std::optional(glm::dvec3((*n)[0], (*n)[1], (*n)[2])) : std::nullopt;
    }

    std::optional<glm::dvec3> unit_vector(std::string_view key) const {
        const std::optional<glm::dvec3> v = vector(key, finite);
        if (!v)
            return std::nullopt;
        const double length = std::hypot(v->x, v->y, v->z);
        if (!(std::abs(length - 1) <= nearly_unit)) {
            not_unit(key, length, {v->x, v->y, v->z});
            return std::nullopt;
        }
        return *v / length;
    }

    // [w, x, y, z]; kept bit for bit when it is of unit length already.
    std::optional<glm::dquat> unit_quaternion(std::string_view key) const {
        const auto n = numbers<4>(key, finite);
        if (!n)
            return std::nullopt;
        const auto [w, x, y, z] = *n;
        const double length = std::hypot(std::hypot(w, x), std::hypot(y, z));
        const glm::dquat q{w, x, y, z};
        if (std::abs(length - 1) <= exactly_unit)
            return q;
        if (std::abs(length - 1) <= nearly_unit)
            return glm::dquat{w / length, x / length, y / length, z / length};
        not_unit(key, length, {w, x, y, z});
        return std::nullopt;
    }

    // [r, g, b] from 0 to 1, or "#rrggbb".
    std::optional<glm::vec3> colour(std::string_view key) const {
        const toml::node *value = node(key);
        if (!value)
            return std::nullopt;
        if (const auto *string = value->as_string()) {
            const std::string &text = string->get();
            std::uint32_t rgb = 0;
            if (text.size() == 7 && text[0] == '#') {
                const auto [end, failure] =
                    std::from_chars(text.data() + 1, text.data() + 7, rgb, 16);
                if (failure == std::errc{} && end == text.data() + 7)
                    return glm::vec3(static_cast<float>((rgb >> 16) & 0xFF) / 255.0F,
                                     static_cast<float>((rgb >> 8) & 0xFF) / 255.0F,
                                     static_cast<float>(rgb & 0xFF) / 255.0F);
            }
            report_.error(
                position_of(*value), std::string(key) + " " + in_quotes(text) + " is not a colour",
                R"(write "#rrggbb", as in "#ff8800", or [r, g, b] with numbers from 0 to 1)");
            return std::nullopt;
        }
        const auto n = numbers<3>(*value, std::string(key), fraction);
        return n ? std::optional(glm::vec3(glm::dvec3((*n)[0], (*n)[1], (*n)[2]))) : std::nullopt;
    }

    // An angle in radians: from `key`, or in degrees from `key`_deg, one of them at most. The
    // bounds are in degrees.
    std::optional<double> angle(std::string_view key, const Bounds &degrees) const {
        const std::string degree_key = std::string(key) + "_deg";
        const std::string_view chosen = one_of({degree_key, key}, false, "");
        if (chosen.empty())
            return std::nullopt;
        if (chosen == degree_key) {
            const std::optional<double> value = number(degree_key, degrees);
            return value ? std::optional(*value * degree) : std::nullopt;
        }
        const std::optional<double> value = number(key, finite);
        if (!value)
            return std::nullopt;
        // A grain of tolerance, so that a bound in degrees survives its conversion.
        const double grain = 1e-12 * std::abs(degrees.max);
        if (*value / degree < degrees.min - grain || *value / degree > degrees.max + grain) {
            error(key, std::string(key) + " is " + shortest(*value) + " (radians)",
                  "in degrees it must be " + std::string(degrees.text));
            return std::nullopt;
        }
        return value;
    }

    std::optional<double> number(const toml::node &value, const std::string &name,
                                 const Bounds &bounds) const {
        if (!value.is_number()) {
            wrong_type(value, name, bounds.text);
            return std::nullopt;
        }
        const double x = value.is_integer() ? static_cast<double>(value.as_integer()->get())
                                            : value.as_floating_point()->get();
        if (x >= bounds.min && x <= bounds.max)
            return x;
        report_.error(position_of(value), name + " is " + shortest(x),
                      "it must be " + std::string(bounds.text));
        return std::nullopt;
    }

    std::optional<std::int64_t> integer(const toml::node &value, const std::string &name,
                                        std::int64_t min, std::int64_t max) const {
        const std::string wanted =
            "a whole number from " + std::to_string(min) + " to " + std::to_string(max);
        if (!value.is_integer()) {
            wrong_type(value, name, wanted);
            return std::nullopt;
        }
        const std::int64_t n = value.as_integer()->get();
        if (n >= min && n <= max)
            return n;
        report_.error(position_of(value), name + " is " + std::to_string(n),
                      "it must be " + wanted);
        return std::nullopt;
    }

    void wrong_type(const toml::node &value, const std::string &name,
                    std::string_view wanted) const {
        std::string what = name + " is " + std::string(type_name(value));
        if (const auto *number = value.as_floating_point())
            what = name + " is " + shortest(number->get());
        report_.error(position_of(value), std::move(what), "it must be " + std::string(wanted));
    }

  private:
    // Keys that one looks for here but that belong elsewhere.
    static std::optional<std::string> misplaced(std::string_view key, std::string_view title) {
        const bool is_body = title.starts_with("[[body]]");
        if (is_body && (key == "friction" || key == "restitution"))
            return std::string(key) + " belongs to a [[material]], which the body then names";
        if (key == "inertia" && is_body)
            return "it follows from shape and mass";
        return std::nullopt;
    }

    void not_unit(std::string_view key, double length, const std::vector<double> &v) const {
        std::string suggestion = "it cannot be normalised";
        if (length > 0 && std::isfinite(length)) {
            suggestion = "normalised it is [";
            for (std::size_t i = 0; i < v.size(); ++i)
                suggestion += (i > 0 ? ", " : "") + shortest(v[i] / length);
            suggestion += "]";
        }
        error(key, std::string(key) + " has length " + shortest(length) + ", not 1",
              std::move(suggestion));
    }

    Report &report_;
    const toml::table &table_;
    std::string title_;
};

// What the names of one kind of table stand for, and where they were given.
class Names {
  public:
    // False, having reported it, when the name is taken.
    bool add(Report &report, const FilePosition &at, const std::string &kind,
             const std::string &name) {
        const auto [entry, is_new] = lines_.try_emplace(name, at.line);
        if (!is_new)
            report.error(at,
                         "another " + kind + " is named " + in_quotes(name) + " already, at line " +
                             std::to_string(entry->second),
                         "each " + kind + " needs a name of its own");
        return is_new;
    }
    bool contains(const std::string &name) const { return lines_.contains(name); }

    std::string suggestion(const std::string &name) const {
        std::vector<std::string_view> all;
        for (const auto &[known, line] : lines_)
            all.push_back(known);
        return did_you_mean(name, all);
    }

  private:
    std::map<std::string, std::size_t> lines_;
};

inline const toml::table *table_at(Report &report, const Table &parent, std::string_view key,
                                   const std::string &example = {}) {
    const toml::node *node = parent.node(key);
    if (!node)
        return nullptr;
    if (!node->as_table())
        report.error(
            parent.key_position(key), std::string(key) + " is " + std::string(type_name(*node)),
            "it must be a table: " + (example.empty() ? "[" + std::string(key) + "]" : example));
    return node->as_table();
}

// `path` is what stands between the double brackets.
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

// "[[body]] "crate"", or "[[body]]" when there is no usable name.
inline std::string title_of(std::string_view kind, const toml::table &table) {
    std::string title = "[[" + std::string(kind) + "]]";
    if (const auto *name = table.get_as<std::string>("name"))
        title += " " + in_quotes(name->get());
    return title;
}

inline std::optional<std::string> read_name(Report &report, const Table &table,
                                            const std::string &kind, Names &names) {
    if (!table.require("name", "each " + kind + " needs a name of its own"))
        return std::nullopt;
    std::optional<std::string> name = table.string("name");
    if (!name)
        return std::nullopt;
    if (name->find_first_not_of(" \t\r\n") == std::string::npos) {
        table.error("name", "the name is empty", "each " + kind + " needs a name of its own");
        return std::nullopt;
    }
    if (kind == "body" && *name == "world") {
        table.error("name", "\"world\" cannot be the name of a body",
                    "it stands for the world in joints");
        return std::nullopt;
    }
    names.add(report, table.position("name"), kind, *name);
    return name;
}

inline glm::dquat about(const glm::dvec3 &axis, double angle) {
    const double s = std::sin(0.5 * angle);
    return {std::cos(0.5 * angle), s * axis.x, s * axis.y, s * axis.z};
}

// rotation_deg, or axis and angle_deg, or orientation: one of them at most; by default none.
inline glm::dquat read_rotation(Report &report, const Table &table) {
    glm::dquat orientation{1, 0, 0, 0};
    const std::string_view key = table.one_of({"rotation_deg", "axis", "orientation"}, false, "");
    if (table.has("axis"))
        table.require("angle_deg", "axis needs angle_deg, the angle about it");
    else if (table.has("angle_deg"))
        report.error(table.key_position("angle_deg"), table.title() + " has angle_deg but no axis",
                     "axis = [x, y, z] of unit length");
    const std::optional<double> angle = table.number("angle_deg", moderate);
    if (key == "rotation_deg") {
        if (const std::optional<glm::dvec3> angles = table.vector(key, moderate))
            // About x, then about the y and the z axis as turned so far: R = Rx Ry Rz.
            orientation = about({1, 0, 0}, angles->x * degree) *
                          about({0, 1, 0}, angles->y * degree) *
                          about({0, 0, 1}, angles->z * degree);
    } else if (key == "axis") {
        const std::optional<glm::dvec3> axis = table.unit_vector(key);
        if (axis && angle)
            orientation = about(*axis, *angle * degree);
    } else if (key == "orientation") {
        orientation = table.unit_quaternion(key).value_or(orientation);
    }
    return orientation;
}

} // namespace plumb::scene_file
