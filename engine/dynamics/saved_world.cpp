#include "engine/dynamics/saved_world.h"

#include "engine/core/check.h"
#include "engine/dynamics/world.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Visits each column of all the given states.
template <typename Visit, typename... States> void for_columns(Visit visit, States &...states) {
    visit(states.motions...);
    visit(states.paces...);
    visit(states.joints...);
    visit(states.contacts...);
    visit(states.points...);
    visit(states.penalties.points...);
    visit(states.penalties.joints...);
    visit(states.particles...);
    visit(states.torn...);
}

const SavedState &state_of(const SavedWorld *saved) {
    static const SavedState nothing;
    return saved != nullptr ? saved->state : nothing;
}

} // namespace

std::size_t SavedWorld::bytes_beside(const SavedWorld *before) const {
    std::size_t bytes = 0;
    for_columns([&](const auto &column, const auto &other) { bytes += column.bytes_beside(other); },
                state, state_of(before));
    return bytes;
}

void World::save(SavedWorld &into, const SavedWorld *before) const {
    into.model = model_;
    into.method = method_;
    into.settings = settings_;
    into.state.clock = state_.clock;
    into.state.grab = state_.grab;
    for_columns(
        [](const auto &items, auto &column, const auto &other) { column.take(items, other); },
        state_, into.state, state_of(before));
}

void World::restore(const SavedWorld &saved) {
    PLUMB_CHECK(saved.model != nullptr, "nothing was saved");
    if (saved.model != model_) {
        // Edits copy a model that is shared, so this one is not changed while `saved` lives.
        model_ = std::const_pointer_cast<Model>(saved.model);
        scratch_ = Scratch{};
    }
    scratch_.stays.clear();
    state_.clock = saved.state.clock;
    state_.grab = saved.state.grab;
    for_columns([](auto &items, const auto &column) { column.give(items); }, state_, saved.state);
    method_ = saved.method;
    use(saved.settings);
    scratch_.contacts_are_current = false;
    scratch_.impacts.clear();
    report_ = StepReport{};
}

} // namespace plumb::inline PLUMB_PRECISION
