#include "engine/scene/file/joint.h"

#include <algorithm>

namespace plumb::scene_file {

Words joint_keys_in_files() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all{
            "name",          "type",          "body_a",         "body_b",         "anchor",
            "anchor_a",      "anchor_b",      "anchor_a_local", "anchor_b_local", "axis",
            "frame_a_local", "frame_b_local", "impulses",       "penalties",      "chain"};
        const auto add = [&all](const JointKey &key) {
            for (const std::string &name : {std::string(key.name), std::string(key.name) + "_deg"})
                if ((name == key.name || key.is_angle()) &&
                    std::ranges::find(all, name) == all.end())
                    all.push_back(name);
        };
        for (const JointKey &key : common_joint_keys())
            add(key);
        for (const JointTypeInfo *type : joint_types())
            for (const JointKey &key : type->keys)
                add(key);
        return all;
    }();
    static const std::vector<std::string_view> words(names.begin(), names.end());
    return words;
}

namespace {

Words type_names() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> all;
        for (const JointTypeInfo *type : joint_types())
            all.push_back(type->name);
        return all;
    }();
    return names;
}

// "a", "b" or "c"
std::string list_of(const std::vector<std::string_view> &names, const std::string &last) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + in_quotes(names[i]);
    return text;
}

// The key as written in the table, perhaps in degrees; empty when absent.
std::string present(const Table &table, const JointKey &key) {
    const std::string degree_key = std::string(key.name) + "_deg";
    return table.has(key.name)                       ? std::string(key.name)
           : key.is_angle() && table.has(degree_key) ? degree_key
                                                     : "";
}

std::string_view chosen_key(const Table &table, const JointKey &key,
                            const std::string &in_degrees) {
    return key.is_angle()        ? table.one_of({in_degrees, key.name}, false, "")
           : table.has(key.name) ? key.name
                                 : std::string_view{};
}

// Both numbers, angles in radians.
std::optional<std::array<double, 2>> read_pair(const Table &table, const JointKey &key) {
    const std::string degree_key = std::string(key.name) + "_deg";
    const std::string_view chosen = chosen_key(table, key, degree_key);
    if (chosen.empty())
        return std::nullopt;
    const double unit = chosen == degree_key ? degree : 1;
    Bounds bounds = key.bounds;
    if (key.is_angle()) {
        // A small tolerance, so that a value at a bound in degrees survives conversion.
        const double scale = (1 + 1e-12) * degree / unit;
        bounds = {scale * bounds.min, scale * bounds.max, bounds.text};
    }
    std::optional<std::array<double, 2>> pair = table.numbers<2>(chosen, bounds);
    if (!pair)
        return std::nullopt;
    for (double &value : *pair)
        value *= unit;
    if ((*pair)[0] > (*pair)[1]) {
        table.error(chosen, "the lower value of " + std::string(chosen) + " is above the upper",
                    "write [lower, upper]");
        return std::nullopt;
    }
    return pair;
}

// Reads the value of a key that is present.
struct ReadKey {
    const Table &table;
    const JointKey &key;
    JointDesc &joint;

    std::optional<double> number() const {
        return key.is_angle() ? table.angle(key.name, key.bounds)
                              : table.number(key.name, key.bounds);
    }
    void operator()(JointKey::Length) const {
        joint.min_length = joint.max_length = number().value_or(0);
    }
    void operator()(bool JointDesc::*member) const {
        joint.*member = table.boolean(key.name).value_or(joint.*member);
    }
    void operator()(double JointDesc::*member) const {
        joint.*member = number().value_or(joint.*member);
    }
    void operator()(std::optional<double> JointDesc::*member) const { joint.*member = number(); }
    void operator()(std::optional<std::array<double, 2>> JointDesc::*member) const {
        joint.*member = read_pair(table, key);
    }
};

void read_keys(const Table &table, const std::vector<JointKey> &keys, JointDesc &joint) {
    for (const JointKey &key : keys) {
        const std::string name = present(table, key);
        if (name.empty())
            continue;
        std::visit(ReadKey{table, key, joint}, key.member);
        const auto needed = std::ranges::find(keys, key.needs, &JointKey::name);
        if (needed != keys.end() && present(table, *needed).empty())
            table.error(name, table.title() + " has " + name + " but no " + std::string(key.needs),
                        "give " + std::string(needed->name) + ", " + std::string(needed->about) +
                            (needed->unit.empty() ? "" : " (" + std::string(needed->unit) + ")"));
    }
}

// Reports keys that only other types have.
void refuse_keys_of_others(Report &report, const Table &table, const JointTypeInfo &type) {
    const auto refuse = [&](std::string_view key, const std::vector<std::string_view> &types) {
        if (table.has(key))
            report.error(table.key_position(key),
                         "a " + std::string(type.name) + " joint has no " + std::string(key),
                         "it belongs to type = " + list_of(types, " or "));
    };
    std::vector<std::string_view> with_axis;
    std::vector<std::string_view> with_frames;
    for (const JointTypeInfo *other : joint_types()) {
        if (other->frames == JointTypeInfo::Frames::axis)
            with_axis.push_back(other->name);
        if (other->frames != JointTypeInfo::Frames::none)
            with_frames.push_back(other->name);
    }
    if (type.frames != JointTypeInfo::Frames::axis)
        refuse("axis", with_axis);
    if (type.frames == JointTypeInfo::Frames::none)
        for (const std::string_view key : {"frame_a_local", "frame_b_local"})
            refuse(key, with_frames);
    const auto belongs = [](const JointTypeInfo &to, std::string_view key) {
        return std::ranges::any_of(to.keys, [&](const JointKey &own) {
            return key == own.name || (own.is_angle() && key == std::string(own.name) + "_deg");
        });
    };
    for (const std::string_view key : joint_keys_in_files()) {
        std::vector<std::string_view> owners;
        for (const JointTypeInfo *other : joint_types())
            if (belongs(*other, key))
                owners.push_back(other->name);
        if (!owners.empty() && !belongs(type, key))
            refuse(key, owners);
    }
}

void read_lengths(JointTable &source) {
    const Table &table = source.table;
    const JointDesc &joint = source.joint;
    if (source.type.type != JointType::distance)
        return;
    table.one_of({"length", "max_length"}, false, "");
    table.one_of({"length", "min_length"}, false, "");
    source.has_length = table.has("length") || table.has("max_length");
    if (table.has("min_length") && table.has("max_length") && joint.min_length > joint.max_length)
        table.error("min_length", "min_length is above max_length",
                    "the anchors are at least min_length and at most max_length apart");
}

// Reads one value per row of the type.
void read_rows(JointTable &source, const std::string &key,
               std::array<double, max_joint_rows> &rows) {
    const toml::node *node = source.table.node(key);
    if (node == nullptr)
        return;
    const std::size_t count = source.type.rows.size();
    const toml::array *elements = node->as_array();
    if (elements == nullptr || elements->size() != count) {
        source.table.error(
            key,
            key + (elements == nullptr ? " is " + std::string(type_name(*node))
                                       : " has " + std::to_string(elements->size()) + " elements"),
            "for a " + std::string(source.type.name) + " joint it must be an array of " +
                std::to_string(count) + " numbers");
        return;
    }
    for (std::size_t i = 0; i < count; ++i)
        rows[i] =
            source.table.number(*elements->get(i), key + "[" + std::to_string(i) + "]", finite)
                .value_or(0);
}

} // namespace

const JointTypeInfo *read_joint_type(const Table &table) {
    const Words names = type_names();
    if (!table.require("type", "type = " + list_of({names.begin(), names.end()}, " or ")))
        return nullptr;
    const std::optional<std::size_t> choice = table.choice("type", names);
    return choice ? joint_types()[*choice] : nullptr;
}

void read_joint_values(Report &report, JointTable &source) {
    source.joint.type = source.type.type;
    refuse_keys_of_others(report, source.table, source.type);
    read_keys(source.table, source.type.keys, source.joint);
    read_keys(source.table, common_joint_keys(), source.joint);
    read_lengths(source);
    read_rows(source, "impulses", source.joint.impulses);
    read_rows(source, "penalties", source.joint.penalties);
}

} // namespace plumb::scene_file
