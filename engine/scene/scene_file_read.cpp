#include "engine/scene/expect.h"
#include "engine/scene/repeat.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_file_number.h"
#include "engine/scene/scene_file_spelling.h"
#include "engine/scene/scene_file_warnings.h"
#include "engine/scene/shape_desc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include <glm/geometric.hpp>

// Compiled into this file alone, whatever the build system says, and reporting errors as values.
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

namespace plumb {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double exactly_unit = 1e-6; // within this, a unit vector is taken as it is
constexpr double nearly_unit = 1e-3;  // within this, it is taken as rounded by hand, and normalised

using Words = std::span<const std::string_view>;

// What a number may be, and how to say so.
struct Bounds {
    double min;
    double max;
    std::string_view text;
};
constexpr double huge = max_scene_magnitude;
constexpr Bounds finite{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max(),
                        "a finite number"};
constexpr Bounds moderate{-huge, huge, "a number between -1e9 and 1e9"};
constexpr Bounds positive{1 / huge, huge, "a positive number, from 1e-9 to 1e9"};
constexpr Bounds not_negative{0, huge, "a number from 0 to 1e9"};
constexpr Bounds fraction{0, 1, "a number from 0 to 1"};
constexpr Bounds above_zero{std::numeric_limits<double>::denorm_min(),
                            std::numeric_limits<double>::max(), "a number above 0"};

std::string in_quotes(std::string_view name) {
    return '"' + std::string(name) + '"';
}

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

class SceneReader {
  public:
    SceneReader(const toml::table &root, const std::vector<std::string> &known_methods)
        : root_(root), known_methods_(known_methods.begin(), known_methods.end()) {}

    SceneFileResult read(std::string name) {
        static constexpr std::array<std::string_view, 10> keys{
            "title",    "description", "world", "methods", "camera",
            "material", "body",        "joint", "expect",  "state"};
        scene_.name = std::move(name);
        const Table top(report_, root_, "the top level of a scene", keys);
        scene_.title = top.string("title").value_or("");
        scene_.description = top.string("description").value_or("");
        if (const toml::table *table = table_at(top, "world"))
            read_world(*table);
        if (const toml::table *table = table_at(top, "methods"))
            read_methods(*table);
        if (const toml::table *table = table_at(top, "camera"))
            read_camera(*table);
        for_each(top, "material", [this](const toml::table &table) { read_material(table); });
        for_each(top, "body", [this](const toml::table &table) { read_body(table); });
        for_each(top, "joint", [this](const toml::table &table) { read_joint(table); });
        for_each(top, "expect", [this](const toml::table &table) { read_expect(table); });
        if (const toml::table *table = table_at(top, "state"))
            read_state(*table);

        if (report_.error_count() == 0)
            for (SceneMessage &warning : scene_warnings(scene_, positions_))
                report_.add(std::move(warning));
        return {std::move(scene_), report_.in_file_order()};
    }

  private:
    const toml::table *table_at(const Table &parent, std::string_view key,
                                const std::string &example = {}) {
        const toml::node *node = parent.node(key);
        if (!node)
            return nullptr;
        if (!node->as_table())
            report_.error(parent.key_position(key),
                          std::string(key) + " is " + std::string(type_name(*node)),
                          "it must be a table: " +
                              (example.empty() ? "[" + std::string(key) + "]" : example));
        return node->as_table();
    }

    // `path` is what stands between the double brackets.
    template <typename Read>
    void for_each(const Table &parent, std::string_view key, Read &&read,
                  std::string_view path = {}) {
        const toml::node *node = parent.node(key);
        if (!node)
            return;
        const std::string suggestion =
            "write [[" + std::string(path.empty() ? key : path) + "]] for each " + std::string(key);
        const toml::array *array = node->as_array();
        if (!array) {
            report_.error(parent.key_position(key),
                          std::string(key) + " is " + std::string(type_name(*node)), suggestion);
            return;
        }
        for (const toml::node &element : *array) {
            if (const toml::table *table = element.as_table())
                read(*table);
            else
                report_.error(position_of(element),
                              std::string(key) + " holds " + std::string(type_name(element)),
                              suggestion);
        }
    }

    // "[[body]] "crate"", or "[[body]]" when there is no usable name.
    static std::string title_of(std::string_view kind, const toml::table &table) {
        std::string title = "[[" + std::string(kind) + "]]";
        if (const auto *name = table.get_as<std::string>("name"))
            title += " " + in_quotes(name->get());
        return title;
    }

    std::optional<std::string> read_name(const Table &table, const std::string &kind,
                                         Names &names) {
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
        names.add(report_, table.position("name"), kind, *name);
        return name;
    }

    // ---- world, methods, camera ----

    void read_world(const toml::table &source) {
        static constexpr std::array<std::string_view, 7> keys{
            "gravity", "dt", "method", "substeps", "iterations", "precision", "seed"};
        const Table table(report_, source, "[world]", keys);
        WorldDesc &world = scene_.world;
        world.gravity = table.vector("gravity", moderate).value_or(world.gravity);
        read_dt(table);
        if (const std::optional<std::string> method = table.string("method")) {
            check_method(*method, table.position("method"));
            world.method = *method;
        }
        world.settings = read_settings(table);
        static constexpr std::array<std::string_view, 2> precisions{"float", "double"};
        if (const std::optional<std::size_t> precision = table.choice("precision", precisions))
            world.precision = *precision == 0 ? Precision::single : Precision::dual;
        world.seed = table.natural("seed").value_or(world.seed);
        positions_.dt = table.position("dt");
    }

    void read_dt(const Table &table) {
        static constexpr Bounds step{1 / huge, 1,
                                     "a number of seconds from 1e-9 to 1, or a "
                                     "fraction in quotes such as \"1/60\""};
        const toml::node *node = table.node("dt");
        if (!node)
            return;
        if (const auto *text = node->as_string()) {
            const std::optional<double> value = parse_fraction(text->get());
            if (!value || !(*value >= step.min && *value <= step.max))
                table.error("dt", "dt is " + in_quotes(text->get()),
                            "it must be " + std::string(step.text));
            else
                scene_.world.dt = *value;
            return;
        }
        scene_.world.dt = table.number("dt", step).value_or(scene_.world.dt);
    }

    // "a/b" with plain numbers.
    static std::optional<double> parse_fraction(std::string_view text) {
        const auto strip = [](std::string_view part) {
            while (!part.empty() && part.front() == ' ')
                part.remove_prefix(1);
            while (!part.empty() && part.back() == ' ')
                part.remove_suffix(1);
            return part;
        };
        const auto parse = [](std::string_view part) -> std::optional<double> {
            double value = 0;
            const auto [end, failure] =
                std::from_chars(part.data(), part.data() + part.size(), value);
            const bool all = failure == std::errc{} && end == part.data() + part.size();
            return all ? std::optional(value) : std::nullopt;
        };
        const std::size_t slash = text.find('/');
        if (slash == std::string_view::npos)
            return std::nullopt;
        const std::optional<double> above = parse(strip(text.substr(0, slash)));
        const std::optional<double> below = parse(strip(text.substr(slash + 1)));
        return above && below ? std::optional(*above / *below) : std::nullopt;
    }

    void check_method(const std::string &method, const FilePosition &at) {
        if (!known_methods_.empty() &&
            std::find(known_methods_.begin(), known_methods_.end(), method) == known_methods_.end())
            report_.error(at, "there is no method " + in_quotes(method),
                          did_you_mean(method, known_methods_));
    }

    static MethodSettings read_settings(const Table &table) {
        MethodSettings settings;
        settings.substeps =
            static_cast<int>(table.integer("substeps", 0, max_scene_substeps).value_or(0));
        settings.iterations =
            static_cast<int>(table.integer("iterations", 0, max_scene_substeps).value_or(0));
        return settings;
    }

    void read_methods(const toml::table &source) {
        static constexpr std::array<std::string_view, 2> keys{"substeps", "iterations"};
        for (const auto &[key, value] : source) {
            const std::string name(key.str());
            check_method(name, position_of(key.source()));
            const toml::table *settings = value.as_table();
            if (!settings) {
                report_.error(position_of(key.source()),
                              name + " is " + std::string(type_name(value)),
                              "it must be a table: [methods." + name + "]");
                continue;
            }
            scene_.world.other_methods[name] =
                read_settings(Table(report_, *settings, "[methods." + name + "]", keys));
        }
    }

    void read_camera(const toml::table &source) {
        static constexpr std::array<std::string_view, 8> keys{
            "target", "distance", "yaw_deg", "yaw", "pitch_deg", "pitch", "fov_deg", "fov"};
        static constexpr Bounds upright{-90, 90, "a number from -90 to 90"};
        static constexpr Bounds view{1, 170, "a number from 1 to 170"};
        const Table table(report_, source, "[camera]", keys);
        CameraDesc &camera = scene_.camera;
        camera.target = table.vector("target", moderate).value_or(camera.target);
        camera.distance = table.number("distance", positive).value_or(camera.distance);
        camera.yaw = table.angle("yaw", moderate).value_or(camera.yaw);
        camera.pitch = table.angle("pitch", upright).value_or(camera.pitch);
        camera.fov = table.angle("fov", view).value_or(camera.fov);
    }

    // ---- materials ----

    void read_material(const toml::table &source) {
        static constexpr std::array<std::string_view, 5> keys{"name", "density", "friction",
                                                              "restitution", "color"};
        const Table table(report_, source, title_of("material", source), keys);
        MaterialDesc material;
        material.name = read_name(table, "material", materials_).value_or("");
        material.density = table.number("density", positive).value_or(material.density);
        material.friction = table.number("friction", not_negative).value_or(material.friction);
        material.restitution = table.number("restitution", fraction).value_or(material.restitution);
        material.colour = table.colour("color");
        if (!material.name.empty())
            densities_[material.name] = material.density;
        scene_.materials.push_back(std::move(material));
    }

    // ---- bodies ----

    void read_body(const toml::table &source) {
        static constexpr std::array<std::string_view, 19> keys{"name",
                                                               "kind",
                                                               "shape",
                                                               "radius",
                                                               "half_extents",
                                                               "half_height",
                                                               "material",
                                                               "mass",
                                                               "density",
                                                               "position",
                                                               "rotation_deg",
                                                               "axis",
                                                               "angle_deg",
                                                               "orientation",
                                                               "velocity",
                                                               "angular_velocity",
                                                               "angular_velocity_deg",
                                                               "color",
                                                               "repeat"};
        const Table table(report_, source, title_of("body", source), keys);
        BodyDesc body;
        const std::optional<std::string> name = read_name(table, "body", bodies_);
        body.name = name.value_or("");
        const bool has_shape = read_shape(table, body);
        read_kind(table, body);
        read_mass(table, body, has_shape);
        body.position = table.vector("position", moderate).value_or(body.position);
        read_rotation(table, body);
        read_velocity(table, body);
        body.colour = table.colour("color");

        if (table.has("repeat")) {
            repeat_body(table, body, has_shape);
        } else if (has_room_for(1, max_scene_bodies, scene_.bodies.size(), "bodies",
                                table.position())) {
            if (name)
                bodies_by_name_[*name] = scene_.bodies.size();
            add_body(std::move(body), table.position());
        }
    }

    void add_body(BodyDesc body, const FilePosition &at) {
        scene_.bodies.push_back(std::move(body));
        positions_.bodies.push_back(at);
    }

    bool has_room_for(std::size_t count, std::size_t limit, std::size_t present, const char *what,
                      const FilePosition &at) {
        if (count <= limit && present <= limit - count)
            return true;
        if (!said_too_many_)
            report_.error(at,
                          "too many " + std::string(what) + ": " + std::to_string(present) +
                              " before this, and " + std::to_string(count) + " here",
                          "a scene holds at most " + std::to_string(limit));
        said_too_many_ = true;
        return false;
    }

    bool read_shape(const Table &table, BodyDesc &body) {
        static constexpr std::array<std::string_view, 4> shapes{"sphere", "box", "capsule",
                                                                "plane"};
        if (!table.require("shape", R"(shape = "sphere", "box", "capsule" or "plane")"))
            return false;
        const std::optional<std::size_t> shape = table.choice("shape", shapes);
        if (!shape)
            return false;
        switch (*shape) {
        case 0: {
            table.refuse({"half_extents", "half_height"}, "a sphere", "its size is its radius");
            if (!table.require("radius", "radius = metres"))
                return false;
            const std::optional<double> radius = table.number("radius", positive);
            body.shape = SphereDesc{radius.value_or(1)};
            return radius.has_value();
        }
        case 1: {
            table.refuse({"radius", "half_height"}, "a box", "its size is half_extents");
            if (!table.require("half_extents", "half_extents = [x, y, z] in metres"))
                return false;
            const std::optional<glm::dvec3> half = table.vector("half_extents", positive);
            body.shape = BoxDesc{half.value_or(glm::dvec3(1))};
            return half.has_value();
        }
        case 2: {
            table.refuse({"half_extents"}, "a capsule", "its size is half_height and radius");
            const bool has_height =
                table.require("half_height", "half_height = metres, without the round ends");
            const bool has_radius = table.require("radius", "radius = metres");
            const std::optional<double> height = table.number("half_height", positive);
            const std::optional<double> radius = table.number("radius", positive);
            body.shape = CapsuleDesc{height.value_or(1), radius.value_or(1)};
            return has_height && has_radius && height && radius;
        }
        default:
            table.refuse({"radius", "half_extents", "half_height"}, "a plane",
                         "it is infinite: the solid below y = 0 of its frame");
            body.shape = PlaneDesc{};
            return true;
        }
    }

    void read_kind(const Table &table, BodyDesc &body) {
        static constexpr std::array<std::string_view, 3> kinds{"static", "kinematic", "dynamic"};
        const bool is_plane = std::holds_alternative<PlaneDesc>(body.shape);
        body.kind = is_plane ? BodyKind::fixed : BodyKind::dynamic;
        const std::optional<std::size_t> kind = table.choice("kind", kinds);
        if (!kind)
            return;
        body.kind = static_cast<BodyKind>(*kind);
        if (is_plane && body.kind == BodyKind::dynamic)
            table.error("kind", "a plane cannot be dynamic",
                        R"(kind = "static", which is a plane's default, or "kinematic")");
    }

    void read_mass(const Table &table, BodyDesc &body, bool has_shape) {
        double density = MaterialDesc{}.density;
        if (const std::optional<std::string> material = table.string("material")) {
            body.material = *material;
            if (const auto found = densities_.find(*material); found != densities_.end())
                density = found->second;
            else
                table.error("material", "there is no material " + in_quotes(*material),
                            materials_.suggestion(*material));
        }
        if (std::holds_alternative<PlaneDesc>(body.shape)) {
            table.refuse({"mass", "density"}, "a plane",
                         "it is infinite and never moves by itself");
            return;
        }
        const std::string_view key = table.one_of({"mass", "density"}, false, "");
        const std::optional<double> value =
            key.empty() ? std::nullopt : table.number(key, positive);
        if (key == "mass") {
            body.mass = value;
            return;
        }
        if (!key.empty() && !value)
            return;
        const double mass = value.value_or(density) * volume(body.shape);
        if (value)
            body.mass = mass;
        if (has_shape && !(mass >= positive.min && mass <= positive.max))
            table.error(key.empty() ? "shape" : key,
                        "density times volume makes a mass of " + shortest(mass) + " kg",
                        "it must be " + std::string(positive.text) + "; give a mass");
    }

    static glm::dquat about(const glm::dvec3 &axis, double angle) {
        const double s = std::sin(0.5 * angle);
        return {std::cos(0.5 * angle), s * axis.x, s * axis.y, s * axis.z};
    }

    void read_rotation(const Table &table, BodyDesc &body) {
        const std::string_view key =
            table.one_of({"rotation_deg", "axis", "orientation"}, false, "");
        if (table.has("axis"))
            table.require("angle_deg", "axis needs angle_deg, the angle about it");
        else if (table.has("angle_deg"))
            report_.error(table.key_position("angle_deg"),
                          table.title() + " has angle_deg but no axis",
                          "axis = [x, y, z] of unit length");
        const std::optional<double> angle = table.number("angle_deg", moderate);
        if (key == "rotation_deg") {
            if (const std::optional<glm::dvec3> angles = table.vector(key, moderate))
                // About x, then about the y and the z axis as turned so far: R = Rx Ry Rz.
                body.orientation = about({1, 0, 0}, angles->x * degree) *
                                   about({0, 1, 0}, angles->y * degree) *
                                   about({0, 0, 1}, angles->z * degree);
        } else if (key == "axis") {
            const std::optional<glm::dvec3> axis = table.unit_vector(key);
            if (axis && angle)
                body.orientation = about(*axis, *angle * degree);
        } else if (key == "orientation") {
            body.orientation = table.unit_quaternion(key).value_or(body.orientation);
        }
    }

    void read_velocity(const Table &table, BodyDesc &body) {
        const std::optional<glm::dvec3> velocity = table.vector("velocity", moderate);
        const std::string_view key =
            table.one_of({"angular_velocity", "angular_velocity_deg"}, false, "");
        std::optional<glm::dvec3> angular;
        if (!key.empty())
            angular = table.vector(key, moderate);
        if (angular && key == "angular_velocity_deg")
            angular = *angular * degree;
        body.velocity = velocity.value_or(body.velocity);
        body.angular_velocity = angular.value_or(body.angular_velocity);
        if (body.kind != BodyKind::fixed)
            return;
        const std::string suggestion = R"(kind = "kinematic" moves as told, "dynamic" by forces)";
        if (body.velocity != glm::dvec3(0))
            report_.error(table.key_position("velocity"), "a static body has no velocity",
                          suggestion);
        if (body.angular_velocity != glm::dvec3(0))
            report_.error(table.key_position(key), "a static body has no " + std::string(key),
                          suggestion);
    }

    // ---- repeats of bodies ----

    void repeat_body(const Table &table, const BodyDesc &body, bool has_shape) {
        Group &group = groups_[body.name];
        group = {scene_.bodies.size(), 0, false};
        const toml::table *source =
            table_at(table, "repeat", R"(repeat = { kind = "stack", count = 10 })");
        if (!source)
            return;
        const std::size_t errors = report_.error_count();
        const std::optional<Repeat> repeat = read_repeat(*source, table.title(), body, has_shape);
        if (!repeat || report_.error_count() != errors ||
            !has_room_for(repeat_count(*repeat), max_scene_bodies, scene_.bodies.size(), "bodies",
                          table.position("repeat")))
            return;
        // A sequence of its own for each body, so that adding one leaves the others where they are.
        Random random(scene_.world.seed ^ name_hash(body.name));
        const std::vector<Placement> placed = placements(*repeat, body.position, random);
        if (placed.size() < repeat_count(*repeat)) {
            table.error("repeat",
                        "only " + std::to_string(placed.size()) + " of " +
                            std::to_string(repeat_count(*repeat)) +
                            " bodies found a place at least min_distance from the others",
                        "fewer bodies, a smaller min_distance or larger half_extents");
            return;
        }
        if (body.name.empty())
            return; // that is reported already
        for (std::size_t i = 0; i < placed.size(); ++i) {
            BodyDesc copy = body;
            copy.name += "_" + std::to_string(i);
            copy.position = placed[i].position;
            if (placed[i].turn != glm::dquat(1, 0, 0, 0)) {
                copy.orientation = placed[i].turn * body.orientation;
                copy.velocity = placed[i].turn * body.velocity;
                copy.angular_velocity = placed[i].turn * body.angular_velocity;
            }
            if (!bodies_.add(report_, table.position("name"), "body", copy.name))
                return;
            bodies_by_name_[copy.name] = scene_.bodies.size();
            add_body(std::move(copy), table.position());
        }
        group.count = placed.size();
        group.is_complete = true;
    }

    // FNV-1a, 64 bits.
    static std::uint64_t name_hash(std::string_view name) {
        std::uint64_t hash = 0xCBF29CE484222325ULL;
        for (const char c : name)
            hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
        return hash;
    }

    std::optional<Repeat> read_repeat(const toml::table &source, const std::string &title,
                                      const BodyDesc &body, bool has_shape) {
        static constexpr std::array<std::string_view, 6> kinds{"grid",    "stack", "line",
                                                               "pyramid", "ring",  "scatter"};
        static constexpr std::array<std::string_view, 3> grid_keys{"kind", "count", "spacing"};
        static constexpr std::array<std::string_view, 4> stack_keys{"kind", "count", "spacing",
                                                                    "turn_deg"};
        static constexpr std::array<std::string_view, 3> line_keys{"kind", "count", "step"};
        static constexpr std::array<std::string_view, 4> pyramid_keys{"kind", "base", "spacing",
                                                                      "square"};
        static constexpr std::array<std::string_view, 4> ring_keys{"kind", "count", "radius",
                                                                   "facing"};
        static constexpr std::array<std::string_view, 5> scatter_keys{
            "kind", "count", "half_extents", "min_distance", "random_rotation"};
        static constexpr std::array<Words, 6> keys{grid_keys,    stack_keys, line_keys,
                                                   pyramid_keys, ring_keys,  scatter_keys};
        std::string name = "repeat of " + title;
        // Which keys are right depends on the kind, so that is looked up first.
        const auto *kind_node = source.get_as<std::string>("kind");
        const auto found =
            kind_node ? std::find(kinds.begin(), kinds.end(), kind_node->get()) : kinds.end();
        if (found == kinds.end()) {
            report_.error(
                source.contains("kind") ? position_of(*source.get("kind")) : position_of(source),
                kind_node ? "unknown kind " + in_quotes(kind_node->get()) + " of repeat"
                          : name + " has no kind",
                kind_node ? did_you_mean(kind_node->get(), kinds)
                          : R"(kind = "grid", "stack", "line", "pyramid", "ring" or "scatter")");
            return std::nullopt;
        }
        const auto kind = static_cast<std::size_t>(found - kinds.begin());
        const Table table(report_, source, "the " + std::string(kinds[kind]) + " " + name,
                          keys[kind]);
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
            if (std::holds_alternative<PlaneDesc>(body.shape) && !table.has("spacing"))
                table.require("spacing", "a plane has no height to take it from");
            else if (has_shape)
                stack.spacing = 2 * half_bounds(body.shape, body.orientation).y;
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

    // ---- joints ----

    // The body of that name; empty, having reported it, when there is none.
    std::optional<std::size_t> find_body(const Table &table, std::string_view key) {
        const std::optional<std::string> name = table.string(key);
        if (!name)
            return std::nullopt;
        if (const auto found = bodies_by_name_.find(*name); found != bodies_by_name_.end())
            return found->second;
        if (const auto group = groups_.find(*name); group != groups_.end()) {
            if (group->second.is_complete)
                table.error(key, "the body " + in_quotes(*name) + " is repeated, so there are many",
                            "name one of " + *name + "_0 to " + *name + "_" +
                                std::to_string(group->second.count - 1));
            return std::nullopt;
        }
        // A repeat that failed would have made it, perhaps.
        const std::size_t underscore = name->rfind('_');
        if (underscore != std::string::npos) {
            const auto group = groups_.find(name->substr(0, underscore));
            if (group != groups_.end() && !group->second.is_complete)
                return std::nullopt;
        }
        // Looking through all names is slow in a large scene; after so many one gets the idea.
        constexpr int suggested = 100;
        table.error(key, "there is no body " + in_quotes(*name),
                    ++missing_bodies_ <= suggested ? bodies_.suggestion(*name) : "");
        return std::nullopt;
    }

    struct JointEnd {
        std::optional<std::size_t> body; // none: the world
        std::optional<glm::dvec3> anchor_local;
    };

    void read_joint(const toml::table &source) {
        static constexpr std::array<std::string_view, 13> keys{"name",
                                                               "type",
                                                               "body_a",
                                                               "body_b",
                                                               "anchor",
                                                               "anchor_a",
                                                               "anchor_b",
                                                               "anchor_a_local",
                                                               "anchor_b_local",
                                                               "length",
                                                               "collide_connected",
                                                               "impulse",
                                                               "chain"};
        static constexpr std::array<std::string_view, 2> types{"ball", "distance"};
        const Table table(report_, source, title_of("joint", source), keys);
        const std::size_t errors = report_.error_count();
        JointDesc joint;
        joint.name = read_name(table, "joint", joints_).value_or("");
        if (table.require("type", R"(type = "ball" or "distance")"))
            joint.type = table.choice("type", types).value_or(0) == 0 ? JointType::ball
                                                                      : JointType::distance;
        joint.collide_connected = table.boolean("collide_connected").value_or(false);
        joint.impulse = table.vector("impulse", finite).value_or(joint.impulse);
        if (joint.type == JointType::ball && table.has("type"))
            table.refuse({"length"}, "a ball joint", R"(type = "distance" has a length)");
        const std::optional<double> length = table.number("length", positive);
        if (table.has("chain")) {
            read_chain(table, joint, length, errors);
            return;
        }

        JointEnd a;
        JointEnd b;
        for (const auto &[end, body_key] : {std::pair(&a, "body_a"), std::pair(&b, "body_b")})
            if (const auto *name = source.get_as<std::string>(body_key);
                table.has(body_key) && !(name && name->get() == "world"))
                end->body = find_body(table, body_key);
        const bool is_world_a = is_world(table, "body_a");
        const bool is_world_b = is_world(table, "body_b");
        if (is_world_a && is_world_b)
            report_.error(table.position(), table.title() + " joins the world to itself",
                          "give body_a or body_b the name of a body");
        else if (a.body && b.body && *a.body == *b.body)
            table.error("body_b", table.title() + " joins a body to itself",
                        "body_a and body_b must differ");
        const std::optional<glm::dvec3> common = table.vector("anchor", moderate);
        read_anchor(table, "anchor_a", is_world_a, joint.type, common, a);
        read_anchor(table, "anchor_b", is_world_b, joint.type, common, b);
        if (report_.error_count() != errors ||
            !has_room_for(1, max_scene_joints, scene_.joints.size(), "joints", table.position()))
            return;
        add_joint(table, joint, a, b, length);
    }

    static bool is_world(const Table &table, std::string_view key) {
        const toml::node *node = table.node(key);
        return node == nullptr || (node->is_string() && node->as_string()->get() == "world");
    }

    glm::dvec3 to_local(const std::optional<std::size_t> &index, const glm::dvec3 &world) const {
        if (!index)
            return world;
        const BodyDesc &body = scene_.bodies[*index];
        return glm::conjugate(body.orientation) * (world - body.position);
    }

    glm::dvec3 to_world(const std::optional<std::size_t> &index, const glm::dvec3 &local) const {
        if (!index)
            return local;
        const BodyDesc &body = scene_.bodies[*index];
        return body.position + body.orientation * local;
    }

    // `key` is anchor_a or anchor_b; `common` is the point that stands for both.
    void read_anchor(const Table &table, const std::string &key, bool is_world, JointType type,
                     const std::optional<glm::dvec3> &common, JointEnd &end) {
        const std::string local_key = key + "_local";
        const std::string_view chosen = table.one_of({"anchor", key, local_key}, false, "");
        if (chosen.empty()) {
            const bool has_any = table.has("anchor") || table.has(key) || table.has(local_key);
            if (has_any)
                return;
            if (type == JointType::ball || is_world)
                report_.error(table.position(), table.title() + " has no " + key,
                              "anchor = [x, y, z] is one point of the world for both bodies, " +
                                  key + " one for this body, " + local_key + " one in its frame");
            else
                end.anchor_local = glm::dvec3(0);
            return;
        }
        const std::optional<glm::dvec3> point =
            chosen == "anchor" ? common : table.vector(chosen, moderate);
        if (point)
            end.anchor_local = chosen == local_key ? *point : to_local(end.body, *point);
    }

    // One joint between each of a repeated body's copies and the next.
    void read_chain(const Table &table, const JointDesc &joint, std::optional<double> length,
                    std::size_t errors) {
        table.refuse({"body_a", "body_b", "anchor", "anchor_a", "anchor_b"}, "a chain",
                     "its bodies are the copies of a repeated one, its anchors in their frames: "
                     "anchor_a_local, anchor_b_local");
        if (table.has("anchor_a_local") != table.has("anchor_b_local"))
            table.error(
                table.has("anchor_a_local") ? "anchor_a_local" : "anchor_b_local",
                table.title() + " has only one of anchor_a_local and anchor_b_local",
                "give both, or neither: then a ball joint sits halfway between the centres, "
                "and a distance joint holds the centres");
        const std::optional<glm::dvec3> anchor_a = table.vector("anchor_a_local", moderate);
        const std::optional<glm::dvec3> anchor_b = table.vector("anchor_b_local", moderate);
        const std::optional<std::string> chain = table.string("chain");
        if (!chain)
            return;
        const auto group = groups_.find(*chain);
        if (group == groups_.end()) {
            const bool is_single = bodies_by_name_.contains(*chain);
            table.error("chain",
                        is_single ? "the body " + in_quotes(*chain) + " is not repeated"
                                  : "there is no body " + in_quotes(*chain),
                        is_single ? "a chain runs through the copies of a body with repeat"
                                  : bodies_.suggestion(*chain));
            return;
        }
        if (!group->second.is_complete)
            return; // its mistakes are reported already
        const auto [first, count, is_complete] = group->second;
        static_cast<void>(is_complete);
        if (count < 2) {
            table.error("chain", "there is only one " + in_quotes(*chain),
                        "a chain needs two bodies at least");
            return;
        }
        if (report_.error_count() != errors ||
            !has_room_for(count - 1, max_scene_joints, scene_.joints.size(), "joints",
                          table.position()))
            return;
        for (std::size_t i = 0; i + 1 < count; ++i) {
            JointDesc copy = joint;
            copy.name += "_" + std::to_string(i);
            if (!joints_.add(report_, table.position("name"), "joint", copy.name))
                return;
            JointEnd a{first + i, anchor_a};
            JointEnd b{first + i + 1, anchor_b};
            if (!anchor_a) {
                const glm::dvec3 middle =
                    0.5 * (to_world(a.body, {0, 0, 0}) + to_world(b.body, {0, 0, 0}));
                const bool is_ball = joint.type == JointType::ball;
                a.anchor_local = is_ball ? to_local(a.body, middle) : glm::dvec3(0);
                b.anchor_local = is_ball ? to_local(b.body, middle) : glm::dvec3(0);
            }
            if (!add_joint(table, copy, a, b, length))
                return;
        }
    }

    bool add_joint(const Table &table, JointDesc joint, const JointEnd &a, const JointEnd &b,
                   std::optional<double> length) {
        if (a.body)
            joint.body_a = scene_.bodies[*a.body].name;
        if (b.body)
            joint.body_b = scene_.bodies[*b.body].name;
        joint.anchor_a_local = a.anchor_local.value_or(glm::dvec3(0));
        joint.anchor_b_local = b.anchor_local.value_or(glm::dvec3(0));
        if (joint.type == JointType::distance) {
            joint.length = length.value_or(glm::distance(to_world(a.body, joint.anchor_a_local),
                                                         to_world(b.body, joint.anchor_b_local)));
            if (!(joint.length >= positive.min && joint.length <= positive.max)) {
                report_.error(table.position(),
                              "the anchors of " + table.title() + " are " + shortest(joint.length) +
                                  " m apart, which cannot be its length",
                              "give a length of its own: " + std::string(positive.text));
                return false;
            }
        }
        scene_.joints.push_back(std::move(joint));
        positions_.joints.push_back(table.position());
        return true;
    }

    // ---- expects ----

    void read_expect(const toml::table &source) {
        static constexpr std::array<std::string_view, 12> keys{
            "name", "quantity", "body",    "reduce",   "level",     "from",
            "to",   "equals",   "at_most", "at_least", "tolerance", "source"};
        static constexpr std::array<std::string_view, 3> relations{"equals", "at_most", "at_least"};
        const Table table(report_, source, title_of("expect", source), keys);
        ExpectDesc expect;
        expect.line = table.position().line;
        expect.name = read_name(table, "expect", expects_).value_or("");
        read_quantity(table, expect);
        read_reduction(table, expect);

        expect.from = table.number("from", not_negative).value_or(0);
        if (table.require("to", "to = seconds, the end of the window and of the run")) {
            const std::optional<double> to = table.number("to", not_negative);
            expect.to = to.value_or(expect.from);
            if (to && *to == 0)
                table.error("to", "the window ends at 0 s", "to must be later than the start");
            else if (to && expect.from > *to)
                table.error(table.has("from") ? "from" : "to",
                            "the window from " + shortest(expect.from) + " to " + shortest(*to) +
                                " s is empty",
                            "from must not be after to");
        }

        const std::string_view relation =
            table.one_of({"equals", "at_most", "at_least"}, true, "what must the number be?");
        if (!relation.empty()) {
            expect.relation = static_cast<ExpectDesc::Relation>(
                std::find(relations.begin(), relations.end(), relation) - relations.begin());
            expect.value = table.number(relation, finite).value_or(0);
            if (relation == "equals") {
                if (table.require("tolerance", "how far the truth may be missed, in the "
                                               "quantity's unit"))
                    expect.tolerance = table.number("tolerance", above_zero).value_or(1);
            } else {
                table.refuse({"tolerance"}, "a bound", "put it into the bound itself");
            }
        }
        if (table.require("source", "where does the number come from?")) {
            expect.source = table.string("source").value_or("?");
            if (expect.source.find_first_not_of(" \t\r\n") == std::string::npos)
                table.error("source", "the source is empty", "where does the number come from?");
        }
        scene_.expects.push_back(std::move(expect));
    }

    void read_quantity(const Table &table, ExpectDesc &expect) {
        if (!table.require("quantity", "which quantity of the motion?"))
            return;
        std::vector<std::string_view> names;
        for (const QuantityInfo &quantity : quantities())
            names.push_back(quantity.name);
        const std::optional<std::size_t> chosen = table.choice("quantity", names);
        if (!chosen)
            return;
        expect.quantity = names[*chosen];
        if (!quantities()[*chosen].needs_body) {
            table.refuse({"body"}, expect.quantity, "it is of the whole scene");
            return;
        }
        if (table.require("body", expect.quantity + " is of one body: which?"))
            if (const std::optional<std::size_t> body = find_body(table, "body"))
                expect.body = scene_.bodies[*body].name;
    }

    void read_reduction(const Table &table, ExpectDesc &expect) {
        std::vector<std::string_view> names;
        for (const ReductionInfo &reduction : reductions())
            names.push_back(reduction.name);
        if (const std::optional<std::size_t> chosen = table.choice("reduce", names))
            expect.reduce = names[*chosen];
        else if (table.has("reduce"))
            return;
        expect.level = table.number("level", finite);
        if (!find_reduction(expect.reduce)->uses_level)
            table.refuse({"level"}, "reduce = " + in_quotes(expect.reduce),
                         "period and crossings have one");
    }

    // ---- state ----

    void read_state(const toml::table &source) {
        static constexpr std::array<std::string_view, 2> keys{"step", "contact"};
        const Table table(report_, source, "[state]", keys);
        scene_.step_count = table.natural("step").value_or(0);
        for_each(
            table, "contact", [this](const toml::table &contact) { read_contact(contact); },
            "state.contact");
    }

    void read_contact(const toml::table &source) {
        static constexpr std::array<std::string_view, 4> keys{"body_a", "body_b", "features",
                                                              "impulses"};
        const Table table(report_, source, "[[state.contact]]", keys);
        ContactStateDesc contact;
        for (const auto &[key, name] :
             {std::pair("body_a", &contact.body_a), std::pair("body_b", &contact.body_b)})
            if (table.require(key, "the name of a body"))
                if (const std::optional<std::size_t> body = find_body(table, key))
                    *name = scene_.bodies[*body].name;
        if (!contact.body_a.empty() && contact.body_a == contact.body_b)
            table.error("body_b", "a body is in contact with itself",
                        "body_a and body_b must differ");
        const toml::array *features = array_at(table, "features");
        const toml::array *impulses = array_at(table, "impulses");
        if (!features || !impulses)
            return;
        if (features->size() != impulses->size()) {
            table.error("impulses",
                        "there are " + std::to_string(features->size()) + " features and " +
                            std::to_string(impulses->size()) + " impulses",
                        "there must be as many of one as of the other");
            return;
        }
        for (std::size_t i = 0; i < features->size(); ++i) {
            const std::string index = "[" + std::to_string(i) + "]";
            const std::optional<std::int64_t> feature =
                table.integer(*features->get(i), "features" + index, 0,
                              std::numeric_limits<std::uint32_t>::max());
            const auto impulse = table.numbers<3>(*impulses->get(i), "impulses" + index, finite);
            if (feature && impulse)
                contact.points.push_back({static_cast<std::uint32_t>(*feature),
                                          {(*impulse)[0], (*impulse)[1], (*impulse)[2]}});
        }
        scene_.contacts.push_back(std::move(contact));
    }

    const toml::array *array_at(const Table &table, std::string_view key) {
        if (!table.require(key, "an array, one element for each contact point"))
            return nullptr;
        const toml::node *node = table.node(key);
        if (!node->as_array())
            table.wrong_type(*node, std::string(key), "an array");
        return node->as_array();
    }

    // The copies of a repeated body: their indices, one after the other.
    struct Group {
        std::size_t first = 0;
        std::size_t count = 0;
        bool is_complete = false; // not when the repeat had errors
    };

    const toml::table &root_;
    std::vector<std::string_view> known_methods_;
    Report report_;
    SceneDesc scene_;
    ScenePositions positions_;
    Names materials_;
    Names bodies_;
    Names joints_;
    Names expects_;
    std::map<std::string, double> densities_;
    std::map<std::string, std::size_t> bodies_by_name_;
    std::map<std::string, Group> groups_;
    int missing_bodies_ = 0;
    bool said_too_many_ = false;
};

// The end of the file, as toml++ counts it, lies a little behind its last character.
FilePosition inside(std::string_view text, FilePosition at) {
    std::size_t line = 1;
    std::size_t start = 0;
    while (line < at.line) {
        const std::size_t newline = text.find('\n', start);
        if (newline == std::string_view::npos)
            break;
        start = newline + 1;
        ++line;
    }
    const std::string_view rest = text.substr(start);
    const std::string_view content = rest.substr(0, std::min(rest.size(), rest.find('\n')));
    // Columns count characters: the bytes 10xxxxxx continue one.
    const auto characters =
        static_cast<std::size_t>(std::count_if(content.begin(), content.end(), [](char c) {
            return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
        }));
    return {line, line < at.line ? characters + 1 : std::min(at.column, characters + 1)};
}

} // namespace

bool SceneFileResult::ok() const {
    return std::none_of(messages.begin(), messages.end(), [](const SceneMessage &message) {
        return message.severity == SceneMessage::Severity::error;
    });
}

SceneFileResult parse_scene(std::string_view text, const std::string &path,
                            const std::vector<std::string> &known_methods) {
    const toml::parse_result parsed = toml::parse(text, std::string_view(path));
    if (!parsed) {
        const FilePosition at = inside(text, position_of(parsed.error().source()));
        SceneFileResult result;
        result.messages.push_back({SceneMessage::Severity::error, at.line, at.column,
                                   std::string(parsed.error().description()),
                                   "see https://toml.io for how TOML is written"});
        return result;
    }
    return SceneReader(parsed.table(), known_methods)
        .read(std::filesystem::path(path).stem().string());
}

SceneFileResult load_scene(const std::filesystem::path &path,
                           const std::vector<std::string> &known_methods) {
    // A directory opens, but cannot be read.
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file || file.bad() || std::filesystem::is_directory(path)) {
        SceneFileResult result;
        result.messages.push_back({SceneMessage::Severity::error, 0, 0, "the file cannot be read",
                                   "check that it exists and that you may read it"});
        return result;
    }
    return parse_scene(text.str(), path.string(), known_methods);
}

std::string format_message(const std::string &path, const SceneMessage &message) {
    std::string text = path + ":";
    if (message.line > 0)
        text += std::to_string(message.line) + ":" + std::to_string(message.column) + ":";
    text += message.severity == SceneMessage::Severity::error ? " error: " : " warning: ";
    text += message.what;
    if (!message.suggestion.empty())
        text += "; " + message.suggestion;
    return text;
}

} // namespace plumb
