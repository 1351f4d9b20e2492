#include "app/lab/run/expectation.h"

#include "app/lab/run/run_text.h"
#include "engine/scene/expect.h"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

double scaled(double error, double limit, double value) {
    double ratio = 0;
    if (limit > 0)
        ratio = error / limit;
    else if (error > 0)
        ratio = 1 + error / (value != 0 ? std::abs(value) : 1);
    if (std::isinf(error))
        return error;
    // Round-off must not flip the verdict, nor overflow turn a number into infinity.
    if (error > limit)
        ratio = std::max(ratio, std::nextafter(1.0, 2.0));
    return std::min(ratio, std::numeric_limits<double>::max());
}

} // namespace

std::string_view verdict_name(Verdict verdict) {
    switch (verdict) {
    case Verdict::pending:
        return "pending";
    case Verdict::met:
        return "met";
    case Verdict::missed:
        return "missed";
    case Verdict::unseen:
        return "unseen";
    }
    return "";
}

ExpectOutcome judge(const ExpectDesc &desc, double measured) {
    ExpectOutcome outcome;
    outcome.desc = desc;
    const QuantityInfo *quantity = find_quantity(desc.quantity);
    const bool is_time = desc.reduce == "period" || desc.reduce == "first_crossing";
    outcome.unit = is_time                      ? "s"
                   : desc.reduce == "crossings" ? "1"
                   : quantity != nullptr        ? std::string(quantity->unit)
                                                : "1";
    outcome.measured = measured;
    switch (desc.relation) {
    case ExpectDesc::Relation::equals:
        outcome.error = std::abs(measured - desc.value);
        outcome.limit = desc.tolerance;
        break;
    case ExpectDesc::Relation::at_most:
        if (desc.value > 0) {
            outcome.error = std::max(measured, 0.0);
            outcome.limit = desc.value;
        } else {
            outcome.error = std::max(measured - desc.value, 0.0);
        }
        break;
    case ExpectDesc::Relation::at_least:
        outcome.error = std::max(desc.value - measured, 0.0);
        break;
    }
    if (!std::isfinite(measured))
        outcome.error = std::numeric_limits<double>::infinity();
    outcome.scaled_error = scaled(outcome.error, outcome.limit, desc.value);
    outcome.verdict = outcome.error <= outcome.limit ? Verdict::met : Verdict::missed;
    return outcome;
}

std::string demand(const ExpectOutcome &outcome) {
    const ExpectDesc &desc = outcome.desc;
    switch (desc.relation) {
    case ExpectDesc::Relation::equals:
        if (!desc.curve.empty())
            return "at most " + with_unit(desc.tolerance, outcome.unit) + " off its curve (" +
                   desc.reduce + ")";
        return with_unit(desc.value, outcome.unit) + " ± " +
               with_unit(desc.tolerance, outcome.unit);
    case ExpectDesc::Relation::at_most:
        return "at most " + with_unit(desc.value, outcome.unit);
    case ExpectDesc::Relation::at_least:
        return "at least " + with_unit(desc.value, outcome.unit);
    }
    return "";
}

} // namespace plumb
