#include "engine/scene/probe.h"

#include "engine/core/check.h"
#include "engine/core/hash.h"
#include "engine/scene/real/probe_answer.h"

#include <algorithm>
#include <limits>
#include <string>

namespace plumb {

// The header above declares the f32 version; this is its f64 twin, compiled from the same source.
namespace f64 {
ProbeAnswer answer_probe(const ProbeDesc &);
}

namespace {

// A failed check's message without the source location: it is the probe that needs fixing, not the
// code.
std::string reason(const CheckFailure &failure) {
    const std::string text = failure.what();
    return text.substr(0, text.rfind(" (check `"));
}

} // namespace

double ProbeAnswer::value(std::string_view name) const {
    const auto found = std::ranges::find(values, name, &ProbeValue::name);
    return found == values.end() ? std::numeric_limits<double>::quiet_NaN() : found->value;
}

ProbeAnswer answer(const ProbeDesc &probe, Precision precision) {
    try {
        return precision == Precision::f64 ? f64::answer_probe(probe) : f32::answer_probe(probe);
    } catch (const CheckFailure &failure) {
        ProbeAnswer refused;
        refused.refusal = reason(failure);
        return refused;
    }
}

std::uint64_t hash_of_answers(std::span<const ProbeDesc> probes, Precision precision) {
    StateHash hash;
    for (const ProbeDesc &probe : probes) {
        const ProbeAnswer found = answer(probe, precision);
        hash.add(static_cast<std::uint64_t>(found.values.size()));
        for (const ProbeValue &value : found.values)
            hash.add(value.value);
        for (const ProbePoint &point : found.points)
            for (int i = 0; i < 3; ++i)
                hash.add(point.position[i]);
    }
    return hash.value();
}

} // namespace plumb
