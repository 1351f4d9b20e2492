#include "engine/scene/file/change.h"

#include "engine/scene/file/reading.h"
#include "engine/scene/file/spelling.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace plumb {

namespace {

using namespace scene_file;

// Follows a path through a file's tables, one key at a time.
class Path {
  public:
    explicit Path(std::string_view whole) : whole_(whole), rest_(whole) {}

    bool at_end() const { return rest_.empty(); }

    std::string_view take_key() {
        const std::size_t dot = std::min(rest_.find('.'), rest_.size());
        return take(dot);
    }

    // Names may contain dots: takes the longest of these that matches here, or empty.
    std::string_view take_name(std::span<const std::string_view> names) {
        std::string_view longest;
        for (const std::string_view name : names)
            if (name.size() > longest.size() && rest_.starts_with(name) &&
                (rest_.size() == name.size() || rest_[name.size()] == '.'))
                longest = name;
        if (!longest.empty())
            take(longest.size());
        return longest;
    }

    std::string_view taken() const { return whole_.substr(0, taken_); }

    [[noreturn]] void refuse(const std::string &why) const {
        throw std::invalid_argument(in_quotes(whole_) + ": " + why);
    }
    [[noreturn]] void refuse(std::string_view word, const std::string &in,
                             std::span<const std::string_view> candidates) const {
        refuse(in + " has no " + in_quotes(word) + "; " + did_you_mean(word, candidates));
    }

  private:
    std::string_view take(std::size_t length) {
        const std::string_view key = rest_.substr(0, length);
        taken_ = static_cast<std::size_t>(rest_.data() - whole_.data()) + length;
        rest_.remove_prefix(std::min(rest_.size(), length + 1));
        return key;
    }

    std::string_view whole_, rest_;
    std::size_t taken_ = 0;
};

toml::node *element(toml::array &array, Path &path) {
    const std::string in(path.taken());
    std::vector<std::string_view> names;
    for (const toml::node &each : array)
        if (const toml::table *table = each.as_table())
            if (const auto *name = table->get_as<std::string>("name"))
                names.push_back(name->get());
    if (!names.empty()) {
        const std::string_view name = path.take_name(names);
        if (name.empty()) {
            const std::string_view word = path.take_key();
            path.refuse("there is no " + in + " " + in_quotes(word) + " in this scene; " +
                        did_you_mean(word, names));
        }
        for (toml::node &each : array)
            if (toml::table *table = each.as_table())
                if (const auto *own = table->get_as<std::string>("name"); own && own->get() == name)
                    return table;
    }
    static constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    const std::string_view key = path.take_key();
    std::size_t index = array.size();
    if (const auto *const axis = std::ranges::find(axes, key);
        axis != axes.end() && array.size() == axes.size() && !array[0].is_table())
        index = static_cast<std::size_t>(axis - axes.begin());
    else if (const auto read = std::from_chars(key.data(), key.data() + key.size(), index);
             read.ec != std::errc() || read.ptr != key.data() + key.size())
        index = array.size();
    if (index >= array.size())
        path.refuse(
            in + " has " + std::to_string(array.size()) + " elements; " +
            (array.size() == axes.size() ? "write x, y or z" : "write an index below that"));
    return array.get(index);
}

bool is_number(const toml::node &node) {
    return node.is_number() || (node.is_string() && [&] {
               try {
                   (void)parse_number(node.as_string()->get());
                   return true;
               } catch (const std::invalid_argument &) {
                   return false;
               }
           }());
}

std::vector<std::string_view> keys_of(const toml::table &table) {
    std::vector<std::string_view> keys;
    for (const auto &[key, value] : table)
        if (is_number(value) || value.is_table() || value.is_array())
            keys.push_back(key.str());
    return keys;
}

// Whole values as integers, for keys that need one.
template <typename Put> void put(double value, const Put &put_in) {
    constexpr double exact = 9007199254740992; // 2^53
    if (value == std::round(value) && std::abs(value) <= exact)
        put_in(static_cast<std::int64_t>(value));
    else
        put_in(value);
}

void put(toml::array &array, const toml::node *element, double value) {
    for (auto at = array.cbegin(); at != array.cend(); ++at)
        if (&*at == element) {
            put(value, [&](auto number) { array.replace(at, number); });
            return;
        }
}

void put(toml::table &table, std::string_view key, double value) {
    put(value, [&](auto number) { table.insert_or_assign(key, number); });
}

// The nonzero components of an array of three numbers, or all three if all are zero.
void add_components(const toml::array &array, const std::string &path,
                    std::vector<std::string> &paths) {
    constexpr std::string_view names = "xyz";
    if (array.size() != names.size() || !std::ranges::all_of(array, is_number))
        return;
    const auto is_zero = [](const toml::node &node) { return node.value<double>() == 0; };
    const bool any = !std::ranges::all_of(array, is_zero);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (!any || !is_zero(array[i]))
            paths.push_back(path + "." + names[i]);
}

// "ball", or "2" for the third one if it has no name: names take precedence, as in `element`.
std::string step_to(const toml::table &table, std::size_t index) {
    const auto *name = table.get_as<std::string>("name");
    return name ? name->get() : std::to_string(index);
}

// `is_wanted` is asked for each key.
template <typename IsWanted>
void add_paths(const toml::table &table, const std::string &before, const IsWanted &is_wanted,
               std::vector<std::string> &paths) {
    for (const auto &[key, value] : table) {
        const std::string path = before + std::string(key.str());
        const bool wanted = is_wanted(key.str());
        if (wanted && is_number(value))
            paths.push_back(path);
        if (const toml::table *inner = value.as_table())
            add_paths(*inner, path + ".", is_wanted, paths);
        const toml::array *array = value.as_array();
        if (array != nullptr && wanted)
            add_components(*array, path, paths);
        for (std::size_t i = 0; array != nullptr && i < array->size(); ++i)
            if (const toml::table *inner = array->get(i)->as_table())
                add_paths(*inner, path + "." + step_to(*inner, i) + ".", is_wanted, paths);
    }
}

// Two ways to give one number; a table may have only one of them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> either_or{{
    {"stiffness", "frequency"},
    {"damping", "damping_ratio"},
    {"mass", "density"},
    {"motor_speed", "motor_speed_deg"},
}};

void erase_other_way(toml::table &table, std::string_view key) {
    for (const auto &[one, other] : either_or)
        if (key == one || key == other)
            table.erase(key == one ? other : one);
}

void change(toml::table &root, const ChangedNumber &number) {
    Path path(number.path);
    toml::table *table = &root;
    while (true) {
        const std::string in(path.taken().empty() ? "a scene" : path.taken());
        const std::string_view key = path.take_key();
        toml::node *node = table->get(key);
        if (node == nullptr) {
            if (table == &root && std::ranges::find(scene_keys, key) != scene_keys.end())
                path.refuse("there is no " + std::string(key) + " in this scene");
            if (table == &root)
                path.refuse(key, in, scene_keys);
            if (!path.at_end())
                path.refuse("the file has no " + std::string(path.taken()) +
                            ", so there is no number to change; add it to the file");
            erase_other_way(*table, key);
            put(*table, key, number.value); // the table's reader checks the key
            return;
        }
        toml::array *array = nullptr;
        while (!path.at_end() && node->is_array()) {
            array = node->as_array();
            node = element(*array, path);
        }
        if (path.at_end() && is_number(*node)) {
            if (array != nullptr)
                put(*array, node, number.value);
            else
                put(*table, key, number.value);
            return;
        }
        if (path.at_end() || !node->is_table())
            path.refuse(std::string(path.taken()) + " is " + std::string(type_name(*node)) +
                        ", not a number" +
                        (node->is_table() ? "; continue with one of its keys; " +
                                                did_you_mean("", keys_of(*node->as_table()))
                         : node->is_array() ? "; continue with x, y, z, a name or an index"
                                            : ""));
        table = node->as_table();
    }
}

} // namespace

SceneFileResult parse_scene(std::string_view text, const std::string &path,
                            const std::vector<std::string> &known_methods,
                            std::span<const ChangedNumber> changed) {
    SceneFileResult result;
    std::optional<toml::table> root = parse_toml(text, path, result.messages);
    if (!root)
        return result;
    for (const ChangedNumber &number : changed)
        change(*root, number);
    Reading reading(path, known_methods);
    reading.counts_may_differ = !changed.empty();
    read_scene(reading, Table(reading.report, *root, "the top level of a scene", scene_keys));
    return {std::move(reading.scene), reading.report.in_file_order()};
}

std::vector<std::string> number_paths(std::string_view text, std::string_view key) {
    std::vector<std::string> paths;
    std::vector<SceneMessage> messages;
    if (std::optional<toml::table> root = parse_toml(text, "", messages)) {
        root->erase("camera");
        add_paths(
            *root, "", [&](std::string_view each) { return each == key; }, paths);
    }
    return paths;
}

std::vector<std::string> number_paths(std::string_view text) {
    std::vector<std::string> paths;
    std::vector<SceneMessage> messages;
    if (std::optional<toml::table> root = parse_toml(text, "", messages)) {
        for (const std::string_view part :
             {"camera", "world", "methods", "expect", "state", "command", "recording", "probe"})
            root->erase(part);
        add_paths(
            *root, "", [](std::string_view each) { return each != "color"; }, paths);
    }
    return paths;
}

std::vector<std::string> table_paths(std::string_view text, std::string_view list) {
    std::vector<std::string> paths;
    std::vector<SceneMessage> messages;
    const std::optional<toml::table> root = parse_toml(text, "", messages);
    const toml::array *array = root ? root->get_as<toml::array>(list) : nullptr;
    for (std::size_t i = 0; array != nullptr && i < array->size(); ++i)
        if (const toml::table *table = array->get(i)->as_table())
            paths.push_back(std::string(list) + "." + step_to(*table, i));
    return paths;
}

std::optional<std::string> read_scene_text(const std::filesystem::path &path,
                                           std::vector<SceneMessage> &messages) {
    return read_file(path, messages);
}

} // namespace plumb
