// One charted query: its inputs, and how each method is run and judged on them.
#pragma once

#include "app/lab/queries/query_inputs.h"
#include "app/lab/queries/query_set.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace plumb {

template <typename A, typename B> struct Pair {
    A a;
    B b;
};

// An input and its true answer.
template <typename Input> struct Judged {
    Input input;
    bool truth = false;
    std::uint8_t family = 0;
};

template <typename Input> struct Inputs {
    std::vector<Input> timed;
    std::vector<Judged<Input>> judged;
    std::vector<std::string> families;
};

template <auto Ask, typename Input>
MethodOfQuery method(QueryMethod which, std::shared_ptr<const Inputs<Input>> inputs) {
    MethodOfQuery result;
    result.method = which;
    result.ask_all = [inputs] {
        std::uint64_t yes = 0;
        for (const Input &input : inputs->timed)
            yes += Ask(input) ? 1 : 0;
        return yes;
    };
    result.judge = [inputs] {
        std::vector<FamilyScore> scores;
        for (const std::string &family : inputs->families)
            scores.push_back({family, 0, 0});
        for (const Judged<Input> &one : inputs->judged) {
            FamilyScore &score = scores[one.family];
            ++score.asked;
            score.wrong += Ask(one.input) != one.truth ? 1 : 0;
        }
        return scores;
    };
    return result;
}

template <auto Book, auto Plain, auto Ours, typename Input>
QueryCase query(std::string name, Inputs<Input> &&inputs) {
    const auto shared = std::make_shared<const Inputs<Input>>(std::move(inputs));
    QueryCase result;
    result.name = std::move(name);
    result.batch = shared->timed.size();
    result.methods.push_back(method<Book, Input>(QueryMethod::book, shared));
    result.methods.push_back(method<Plain, Input>(QueryMethod::plain, shared));
    result.methods.push_back(method<Ours, Input>(QueryMethod::ours, shared));
    return result;
}

constexpr std::size_t timed_batch = 1024;

// Lattice inputs, judged in integers, and random ones for timing.
template <typename Input, typename MakeCase, typename MakeTimed>
Inputs<Input> gather(Random &random, std::size_t adversarial, const MakeCase &make_case,
                     const MakeTimed &make_timed) {
    Inputs<Input> inputs;
    inputs.families = lattice_families();
    inputs.judged.reserve(adversarial);
    while (inputs.judged.size() < adversarial) {
        Judged<Input> one;
        const Lattice lattice = any_lattice(random, one.family);
        make_case(lattice, one);
        inputs.judged.push_back(one);
    }
    while (inputs.timed.size() < timed_batch)
        inputs.timed.push_back(make_timed());
    return inputs;
}

// Adds a family judged with a margin: inputs too close to call are redrawn.
template <typename Input, typename Make>
void add_family(Inputs<Input> &inputs, const char *name, std::size_t count, const Make &make) {
    inputs.families.emplace_back(name);
    const auto family = static_cast<std::uint8_t>(inputs.families.size() - 1);
    for (std::size_t i = 0; i < count;) {
        Input input;
        const std::optional<bool> truth = make(input);
        if (!truth)
            continue;
        inputs.judged.push_back({input, *truth, family});
        ++i;
    }
}

} // namespace plumb
