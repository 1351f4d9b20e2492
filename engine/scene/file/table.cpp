#define TOML_IMPLEMENTATION // toml++'s own code comes with its header
#include "engine/scene/file/table.h"

#include "engine/scene/file/number.h"
#include "engine/scene/file/spelling.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace plumb::scene_file {

namespace {

// Covers rotations written from a float world, whose squared length is off by up to ten roundings
// (turn in motion.cpp).
constexpr double exactly_unit = 1e-6;
constexpr double nearly_unit = 1e-3; // within this: rounded by hand, and normalised

// Keys that one might expect here but that belong elsewhere.
std::optional<std::string> misplaced(std::string_view key, std::string_view title) {
    const bool is_body = title.starts_with("[[body]]");
    if (is_body && (key == "friction" || key == "restitution"))
        return std::string(key) + " belongs to a [[material]], which the body then names";
    if (key == "title" || key == "description")
        return std::string(key) + " belongs at the top of the file, before the first [table]";
    if (title.starts_with("[methods.") && find_setting(key) != nullptr)
        return std::string(key) + " belongs to [world]: it is the same for all methods";
    return std::nullopt;
}

glm::dquat about(const glm::dvec3 &axis, double angle) {
    const double s = std::sin(0.5 * angle);
    return {std::cos(0.5 * angle), s * axis.x, s * axis.y, s * axis.z};
}

} // namespace

std::string_view type_name(const toml::node &node) {
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

FilePosition position_of(const toml::source_region &region) {
    return {std::max<std::size_t>(1, region.begin.line),
            std::max<std::size_t>(1, region.begin.column)};
}
FilePosition position_of(const toml::node &node) {
    return position_of(node.source());
}

Table::Table(Report &report, const toml::table &table, std::string title, Words keys)
    : report_(report), table_(table), title_(std::move(title)) {
    for (const auto &[key, value] : table)
        if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
            report.error(position_of(key.source()),
                         "unknown key " + in_quotes(key.str()) + " in " + title_,
                         misplaced(key.str(), title_).value_or(did_you_mean(key.str(), keys)));
}

FilePosition Table::position(std::string_view key) const {
    const toml::node *value = node(key);
    return value ? position_of(*value) : position();
}

FilePosition Table::key_position(std::string_view key) const {
    const auto found = table_.find(key);
    return found == table_.end() ? position() : position_of(found->first.source());
}

void Table::error(std::string_view key, std::string what, std::string suggestion) const {
    report_.error(position(key), std::move(what), std::move(suggestion));
}

bool Table::require(std::string_view key, std::string suggestion) const {
    if (has(key))
        return true;
    report_.error(position(), title_ + " has no " + std::string(key), std::move(suggestion));
    return false;
}

void Table::refuse(std::initializer_list<std::string_view> keys, const std::string &what,
                   const std::string &suggestion) const {
    for (const std::string_view key : keys)
        if (has(key))
            report_.error(key_position(key), what + " has no " + std::string(key), suggestion);
}

std::string_view Table::one_of(std::initializer_list<std::string_view> keys, bool required,
                               const std::string &suggestion) const {
    std::string_view chosen;
    bool several = false;
    for (const std::string_view key : keys) {
        if (!has(key))
            continue;
        if (!chosen.empty()) {
            report_.error(key_position(key),
                          title_ + " has both " + std::string(chosen) + " and " + std::string(key),
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

std::optional<double> Table::number(std::string_view key, const Bounds &bounds) const {
    const toml::node *value = node(key);
    return value ? number(*value, std::string(key), bounds) : std::nullopt;
}

std::optional<std::int64_t> Table::integer(std::string_view key, std::int64_t min,
                                           std::int64_t max) const {
    const toml::node *value = node(key);
    return value ? integer(*value, std::string(key), min, max) : std::nullopt;
}

std::optional<bool> Table::boolean(std::string_view key) const {
    const toml::node *value = node(key);
    if (!value)
        return std::nullopt;
    if (const auto *boolean = value->as_boolean())
        return boolean->get();
    wrong_type(*value, std::string(key), "true or false");
    return std::nullopt;
}

std::optional<std::string> Table::string(std::string_view key) const {
    const toml::node *value = node(key);
    if (!value)
        return std::nullopt;
    if (const auto *string = value->as_string())
        return string->get();
    wrong_type(*value, std::string(key), "a string in quotes");
    return std::nullopt;
}

std::optional<std::uint64_t> Table::natural(std::string_view key) const {
    const std::string_view wanted = "a whole number from 0 to 2^64 - 1 (in quotes from 2^63 on)";
    const toml::node *value = node(key);
    if (!value)
        return std::nullopt;
    if (const auto *integer = value->as_integer(); integer && integer->get() >= 0)
        return static_cast<std::uint64_t>(integer->get());
    if (const auto *string = value->as_string()) {
        const std::string &text = string->get();
        std::uint64_t number = 0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (failure == std::errc{} && end == text.data() + text.size())
            return number;
    }
    report_.error(position_of(*value), std::string(key) + " is not a natural number",
                  "it must be " + std::string(wanted));
    return std::nullopt;
}

std::optional<std::size_t> Table::choice(std::string_view key, Words words) const {
    const std::optional<std::string> word = string(key);
    if (!word)
        return std::nullopt;
    const auto found = std::find(words.begin(), words.end(), *word);
    if (found != words.end())
        return static_cast<std::size_t>(found - words.begin());
    error(key, "unknown " + std::string(key) + " " + in_quotes(*word), did_you_mean(*word, words));
    return std::nullopt;
}

std::optional<glm::dvec3> Table::vector(std::string_view key, const Bounds &bounds) const {
    const auto n = numbers<3>(key, bounds);
    return n ? std::optional(glm::dvec3((*n)[0], (*n)[1], (*n)[2])) : std::nullopt;
}

std::optional<glm::dvec3> Table::unit_vector(std::string_view key) const {
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

std::optional<glm::dquat> Table::unit_quaternion(std::string_view key) const {
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

std::optional<glm::vec3> Table::colour(std::string_view key) const {
    const toml::node *value = node(key);
    if (!value)
        return std::nullopt;
    if (const auto *string = value->as_string()) {
        const std::string &text = string->get();
        std::uint32_t rgb = 0;
        if (text.size() == 7 && text[0] == '#') {
            const auto [end, failure] = std::from_chars(text.data() + 1, text.data() + 7, rgb, 16);
            if (failure == std::errc{} && end == text.data() + 7)
                return glm::vec3(static_cast<float>((rgb >> 16) & 0xFF) / 255.0F,
                                 static_cast<float>((rgb >> 8) & 0xFF) / 255.0F,
                                 static_cast<float>(rgb & 0xFF) / 255.0F);
        }
        report_.error(position_of(*value),
                      std::string(key) + " " + in_quotes(text) + " is not a colour",
                      R"(write "#rrggbb", as in "#ff8800", or [r, g, b] with numbers from 0 to 1)");
        return std::nullopt;
    }
    const auto n = numbers<3>(*value, std::string(key), fraction);
    return n ? std::optional(glm::vec3(glm::dvec3((*n)[0], (*n)[1], (*n)[2]))) : std::nullopt;
}

std::optional<double> Table::angle(std::string_view key, const Bounds &degrees) const {
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
    // A small tolerance, so that a value at a bound in degrees survives conversion.
    const double grain = 1e-12 * std::abs(degrees.max);
    if (*value / degree < degrees.min - grain || *value / degree > degrees.max + grain) {
        error(key, std::string(key) + " is " + shortest(*value) + " (radians)",
              "in degrees it must be " + std::string(degrees.text));
        return std::nullopt;
    }
    return value;
}

std::optional<double> Table::number(const toml::node &value, const std::string &name,
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

std::optional<std::int64_t> Table::integer(const toml::node &value, const std::string &name,
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
    report_.error(position_of(value), name + " is " + std::to_string(n), "it must be " + wanted);
    return std::nullopt;
}

void Table::wrong_type(const toml::node &value, const std::string &name,
                       std::string_view wanted) const {
    std::string what = name + " is " + std::string(type_name(value));
    if (const auto *number = value.as_floating_point()) {
        const std::string digits = shortest(number->get());
        const bool has_point = digits.find_first_not_of("-0123456789") != std::string::npos;
        what = name + " is " + digits + (has_point ? "" : ".0");
    }
    report_.error(position_of(value), std::move(what), "it must be " + std::string(wanted));
}

void Table::not_unit(std::string_view key, double length, const std::vector<double> &v) const {
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

const toml::table *table_at(Report &report, const Table &parent, std::string_view key,
                            const std::string &example) {
    const toml::node *node = parent.node(key);
    if (!node)
        return nullptr;
    if (!node->as_table())
        report.error(
            parent.key_position(key), std::string(key) + " is " + std::string(type_name(*node)),
            "it must be a table: " + (example.empty() ? "[" + std::string(key) + "]" : example));
    return node->as_table();
}

glm::dquat read_rotation(Report &report, const Table &table) {
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
            // About x, then about the rotated y and z axes: R = Rx Ry Rz.
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

bool is_world(const Table &table, std::string_view key) {
    const toml::node *node = table.node(key);
    return node == nullptr || (node->is_string() && node->as_string()->get() == "world");
}

} // namespace plumb::scene_file
