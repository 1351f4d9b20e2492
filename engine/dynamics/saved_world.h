// A save keeps the state column by column. A column whose bits have not changed since the previous
// save is shared with it, so whatever rests is stored once, however often it is saved.
#pragma once

#include "engine/dynamics/method.h"
#include "engine/dynamics/state.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

template <typename Item> class SavedColumn {
  public:
    // Overwrites this column's items in place unless another save shares them.
    void take(const std::vector<Item> &items, const SavedColumn &before) {
        if (before.items_ != nullptr && same_bits(*before.items_, items))
            items_ = before.items_;
        else if (items_ != nullptr && items_.use_count() == 1)
            *items_ = items;
        else
            items_ = std::make_shared<std::vector<Item>>(items);
    }
    void give(std::vector<Item> &items) const {
        if (items_ != nullptr)
            items = *items_;
        else
            items.clear();
    }
    // 0 if it is shared with `other`.
    std::size_t bytes_beside(const SavedColumn &other) const {
        return items_ == nullptr || items_ == other.items_ ? 0 : items_->capacity() * sizeof(Item);
    }

  private:
    static_assert(std::is_trivially_copyable_v<Item>);

    static bool same_bits(const std::vector<Item> &a, const std::vector<Item> &b) {
        const std::span bits_a = std::as_bytes(std::span(a));
        const std::span bits_b = std::as_bytes(std::span(b));
        return bits_a.size() == bits_b.size() &&
               (bits_a.empty() || std::memcmp(bits_a.data(), bits_b.data(), bits_a.size()) == 0);
    }

    std::shared_ptr<std::vector<Item>> items_; // null: none
};

struct SavedPenalties {
    SavedColumn<PointPenalty> points;
    SavedColumn<JointPenalty> joints;
};

struct SavedState {
    SavedColumn<Motion> motions;
    SavedColumn<Pace> paces;
    SavedColumn<JointMemory> joints;
    SavedColumn<ContactMemory> contacts;
    SavedColumn<PointMemory> points;
    SavedPenalties penalties;
    SavedColumn<ParticleMotion> particles;
    SavedColumn<std::uint8_t> torn;
    StateClock clock;
    Grab grab;
};

// Everything that decides the future: the model, which saves share until it is edited, the state,
// the method and the settings.
struct SavedWorld {
    std::shared_ptr<const Model> model;
    SavedState state;
    const Method *method = nullptr;
    StepSettings settings;

    // The bytes of the state that are not shared with another save, which may be null.
    std::size_t bytes_beside(const SavedWorld *before) const;
};

} // namespace plumb::inline PLUMB_PRECISION
