#include "engine/scene/expect.h"
#include "engine/scene/file/number.h"
#include "engine/scene/file/particle.h"
#include "engine/scene/file/reading.h"
#include "engine/scene/joint_type.h"

namespace plumb::scene_file {

namespace {

// The name of an existing spring; reports an error when the scene has no such spring.
std::optional<std::string> read_spring_name(Reading &reading, const Table &table) {
    std::optional<std::string> name = table.string("spring");
    if (name && std::ranges::find(reading.scene.springs, *name, &SpringDesc::name) ==
                    reading.scene.springs.end()) {
        table.error("spring", "there is no spring " + in_quotes(*name),
                    reading.springs.suggestion(*name));
        return std::nullopt;
    }
    return name;
}

// The same for a joint of a type that has the quantity.
std::optional<std::string> read_joint_name(Reading &reading, const Table &table,
                                           const QuantityInfo &quantity) {
    std::optional<std::string> name = table.string("joint");
    if (!name)
        return name;
    const auto found = std::ranges::find(reading.scene.joints, *name, &JointDesc::name);
    if (found == reading.scene.joints.end()) {
        table.error("joint", "there is no joint " + in_quotes(*name),
                    reading.joints.suggestion(*name));
        return std::nullopt;
    }
    if (has_quantity(found->type, quantity))
        return name;
    std::string types;
    for (const JointTypeInfo *type : joint_types())
        if (has_quantity(type->type, quantity))
            types += (types.empty() ? "" : " or ") + in_quotes(type->name);
    table.error("joint",
                in_quotes(*name) + " is of type " + in_quotes(joint_type(found->type).name) +
                    " and has no " + std::string(quantity.name),
                "one of type " + types + " has");
    return std::nullopt;
}

// The name of an existing body, or of a particle if particles have the quantity.
std::string read_body_name(Reading &reading, const Table &table, const QuantityInfo &quantity) {
    const toml::node *name = table.node("body");
    if (name != nullptr && name->is_string() && is_particle(reading, name->as_string()->get())) {
        const std::string &particle = name->as_string()->get();
        if (!quantity.of_particles)
            table.error("body", "there is no body " + in_quotes(particle),
                        "a particle has no " + std::string(quantity.name));
        return particle;
    }
    const std::optional<std::size_t> body = find_body(reading, table, "body");
    return body ? reading.scene.bodies[*body].name : "";
}

void read_subject(Reading &reading, const Table &table, const QuantityInfo &quantity,
                  ExpectDesc &expect) {
    const std::string subject(quantity.subject());
    const std::string measured_on =
        subject.empty()     ? "it is measured on the whole scene"
        : subject == "body" ? "it is measured on a body"
                            : "it is measured on a " + subject + ": " + subject + " = \"...\"";
    for (const std::string_view key : {"body", "spring", "joint"})
        if (key != subject)
            table.refuse({key}, expect.quantity, measured_on);
    if (subject.empty() ||
        !table.require(subject, expect.quantity + " is measured on one " + subject + ": which?"))
        return;
    if (subject == "spring")
        expect.body = read_spring_name(reading, table).value_or("");
    else if (subject == "joint")
        expect.body = read_joint_name(reading, table, quantity).value_or("");
    else
        expect.body = read_body_name(reading, table, quantity);
}

void read_quantity(Reading &reading, const Table &table, ExpectDesc &expect) {
    if (!table.require("quantity", "which quantity is measured?"))
        return;
    std::vector<std::string_view> names;
    for (const QuantityInfo &quantity : quantities())
        names.push_back(quantity.name);
    const std::optional<std::size_t> chosen = table.choice("quantity", names);
    if (!chosen)
        return;
    expect.quantity = names[*chosen];
    read_subject(reading, table, quantities()[*chosen], expect);
}

// Whether `equals` is a curve rather than a number.
bool is_curve(const Table &table) {
    return table.has("equals") && table.node("equals")->is_array();
}

void refuse_curve(const Table &table, const ExpectDesc &expect) {
    std::string names;
    for (const ReductionInfo &reduction : reductions())
        if (reduction.of_distance)
            names += (names.empty() ? "" : " or ") + in_quotes(reduction.name);
    table.error(table.has("reduce") ? "reduce" : "equals",
                "equals is a curve, and reduce = " + in_quotes(expect.reduce),
                "the distance from a curve can be reduced by " + names);
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
                     "period, crossings and first_crossing have one");
    if (is_curve(table) && !find_reduction(expect.reduce)->of_distance)
        refuse_curve(table, expect);
}

void read_curve(const Table &table, ExpectDesc &expect) {
    for (const toml::node &value : *table.node("equals")->as_array()) {
        const std::string name = "equals[" + std::to_string(expect.curve.size()) + "]";
        expect.curve.push_back(table.number(value, name, finite).value_or(0));
    }
    if (const std::size_t count = expect.curve.size(); count < least_curve)
        table.error(
            "equals",
            "equals is a curve of " + std::to_string(count) + (count == 1 ? " value" : " values"),
            "write at least " + std::to_string(least_curve) +
                ", evenly spaced from the start of the window to its end; `plumb reference SCENE "
                "--write` computes them if there is an estimate");
}

void read_estimate(const Table &table, ExpectDesc &expect) {
    expect.estimate = table.number("estimate", not_negative);
    if (expect.estimate && 10 * *expect.estimate >= expect.tolerance)
        table.error("estimate",
                    "the estimate of " + shortest(*expect.estimate) +
                        " is not less than a tenth of the tolerance of " +
                        shortest(expect.tolerance),
                    "a truth must be known ten times more accurately than its tolerance; `plumb "
                    "reference SCENE --write` refines it");
}

// Whether the expectation is of a repeated body's copy that does not exist with a smaller count.
bool is_of_missing_copy(const Reading &reading, const Table &table) {
    const toml::node *name = table.node("body");
    if (name == nullptr || !name->is_string())
        return false;
    const std::string &body = name->as_string()->get();
    const std::size_t underscore = body.rfind('_');
    if (underscore == std::string::npos || reading.bodies_by_name.contains(body))
        return false;
    const auto group = reading.groups.find(body.substr(0, underscore));
    return group != reading.groups.end() && group->second.is_complete;
}

} // namespace

void read_expect(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 15> keys{
        "name", "quantity", "body",    "spring",   "joint",     "reduce",   "level", "from",
        "to",   "equals",   "at_most", "at_least", "tolerance", "estimate", "source"};
    static constexpr std::array<std::string_view, 3> relations{"equals", "at_most", "at_least"};
    const Table table(reading.report, source, title_of("expect", source), keys);
    ExpectDesc expect;
    expect.line = table.position().line;
    if (reading.counts_may_differ && is_of_missing_copy(reading, table))
        return;
    expect.name = read_name(reading.report, table, "expect", reading.expects).value_or("");
    read_quantity(reading, table, expect);
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
        else if (to && expect.from == *to && is_curve(table))
            table.error("from", "the curve's window is the single instant " + shortest(*to) + " s",
                        "from must be before to");
    }

    const std::string_view relation =
        table.one_of({"equals", "at_most", "at_least"}, true, "what must the number be?");
    if (!relation.empty()) {
        expect.relation = static_cast<ExpectDesc::Relation>(
            std::find(relations.begin(), relations.end(), relation) - relations.begin());
        if (is_curve(table))
            read_curve(table, expect);
        else
            expect.value = table.number(relation, finite).value_or(0);
        if (relation == "equals") {
            if (table.require("tolerance", "the allowed error, in the quantity's unit"))
                expect.tolerance = table.number("tolerance", above_zero).value_or(1);
            read_estimate(table, expect);
        } else {
            table.refuse({"tolerance"}, "a bound", "include it in the bound");
            table.refuse({"estimate"}, "a bound", "only a truth found by refinement has one");
        }
    }
    if (table.require("source", "where does the number come from?")) {
        expect.source = table.string("source").value_or("?");
        if (expect.source.find_first_not_of(" \t\r\n") == std::string::npos)
            table.error("source", "the source is empty", "where does the number come from?");
    }
    reading.scene.expects.push_back(std::move(expect));
}

} // namespace plumb::scene_file
