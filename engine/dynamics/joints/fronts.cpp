#include "engine/dynamics/joints/fronts.h"

#include <algorithm>
#include <array>

#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Numbers from one column to the next.
std::size_t stride_of(std::size_t blocks) {
    return (3 * blocks + front_lanes - 1) / front_lanes * front_lanes;
}

// The inverse of a diagonal block, of which the lower triangle is known.
template <typename Number>
typename WideMatrix<Number>::Narrow inverse_at(const FrontColumns<Number> &panel,
                                               std::size_t block) {
    typename WideMatrix<Number>::Narrow all;
    for (int j = 0; j < 3; ++j)
        for (int i = j; i < 3; ++i)
            all[j][i] = all[i][j] = panel.at(3 * block, 3 * block + static_cast<std::size_t>(j))[i];
    return glm::inverse(all);
}

} // namespace

void Fronts::clear() {
    meshes_.clear();
    fronts_.assign(1, {});
    front_of_.clear();
    children_.clear();
    runs_.clear();
    panel_space_ = 0;
    work_space_ = 0;
}

const Fronts::Mesh &Fronts::mesh_of(std::uint32_t first) const {
    return *std::ranges::find(meshes_, first, &Mesh::block);
}

std::span<const FrontRun> Fronts::runs_of(std::uint32_t front) const {
    return std::span(runs_).subspan(fronts_[front].runs,
                                    fronts_[front + 1].runs - fronts_[front].runs);
}

template <typename Number>
FrontColumns<Number> Fronts::panel_of(const Front &front, Memory<Number> &memory) const {
    const std::size_t blocks = front.count + front.rows;
    return {memory.panels.data() + front.panel, 3 * blocks, stride_of(blocks)};
}
template <typename Number>
FrontColumns<Number> Fronts::rest_of(const Front &front, Memory<Number> &memory) const {
    return {memory.work.data() + front.rest, std::size_t{3} * front.rows, stride_of(front.rows)};
}

void Fronts::find_fronts(std::uint32_t first, std::uint32_t last, const FactorColumns &columns) {
    front_of_.resize(last);
    for (std::uint32_t block = first; block < last; ++block) {
        const std::span rows = columns.of(block);
        const std::span before =
            block > first ? columns.of(block - 1) : std::span<const std::uint32_t>{};
        const bool goes_on =
            !before.empty() && before.front() == block && before.size() == rows.size() + 1;
        if (!goes_on)
            fronts_.push_back({.first = block});
        ++fronts_.back().count;
        fronts_.back().rows = static_cast<std::uint32_t>(rows.size());
        front_of_[block] = static_cast<std::uint32_t>(fronts_.size() - 1);
    }
}

// Where the rows of a front's rest are in its parent. None of the runs is in part among the
// parent's own columns.
void Fronts::find_runs(const FactorColumns &columns, const Front &front, const Front &parent) {
    const std::span rows = columns.of(front.first + front.count - 1);
    const std::span others = columns.of(parent.first + parent.count - 1);
    for (std::uint32_t from = 0; from < rows.size(); ++from) {
        std::uint32_t to = rows[from] - parent.first;
        if (to >= parent.count)
            to = parent.count + static_cast<std::uint32_t>(
                                    std::ranges::lower_bound(others, rows[from]) - others.begin());
        if (from > 0 && to != parent.count && runs_.back().to + runs_.back().count == to)
            ++runs_.back().count;
        else
            runs_.push_back({from, to, 1});
    }
}

// Children and their rows, and where the rests are kept: on two stacks, in turns from parent to
// child. In a postorder the children of a front are on top of one, and its own rest goes on the
// other.
void Fronts::find_tree(std::uint32_t first_front, const FactorColumns &columns) {
    const auto last_front = static_cast<std::uint32_t>(fronts_.size());
    const auto parent_of = [&](const Front &front) {
        return front_of_[columns.of(front.first + front.count - 1).front()];
    };
    std::vector<std::uint8_t> stack_of(last_front - first_front, 0);
    for (std::uint32_t i = last_front; i-- > first_front;)
        if (fronts_[i].rows > 0)
            stack_of[i - first_front] = stack_of[parent_of(fronts_[i]) - first_front] == 0 ? 1 : 0;
    std::array<std::size_t, 2> top{}, most{};
    std::vector<std::uint32_t> waiting; // fronts whose rests are on a stack
    for (std::uint32_t i = first_front; i < last_front; ++i) {
        Front &front = fronts_[i];
        const std::uint8_t stack = stack_of[i - first_front];
        front.children = static_cast<std::uint32_t>(children_.size());
        for (; !waiting.empty() && parent_of(fronts_[waiting.back()]) == i; waiting.pop_back()) {
            children_.push_back(waiting.back());
            top[1 - stack] = fronts_[waiting.back()].rest;
        }
        front.runs = static_cast<std::uint32_t>(runs_.size());
        front.rest = top[stack];
        if (front.rows == 0)
            continue;
        find_runs(columns, front, fronts_[parent_of(front)]);
        waiting.push_back(i);
        top[stack] += std::size_t{3} * front.rows * stride_of(front.rows);
        most[stack] = std::max(most[stack], top[stack]);
    }
    for (std::uint32_t i = first_front; i < last_front; ++i)
        fronts_[i].rest += work_space_ + (stack_of[i - first_front] == 0 ? 0 : most[0]);
    work_space_ += most[0] + most[1];
}

void Fronts::add(std::uint32_t first, std::uint32_t last, const FactorColumns &columns) {
    fronts_.pop_back();
    const auto first_front = static_cast<std::uint32_t>(fronts_.size());
    find_fronts(first, last, columns);
    find_tree(first_front, columns);
    const auto last_front = static_cast<std::uint32_t>(fronts_.size());
    std::size_t longest = 0;
    for (Front &front : std::span(fronts_).subspan(first_front)) {
        const std::size_t stride = stride_of(front.count + front.rows);
        longest = std::max(longest, stride);
        front.panel = panel_space_;
        panel_space_ += std::size_t{3} * front.count * stride;
    }
    fronts_.push_back({.children = static_cast<std::uint32_t>(children_.size()),
                       .runs = static_cast<std::uint32_t>(runs_.size()),
                       .panel = panel_space_});
    meshes_.push_back({first, first_front, last_front, work_space_});
    work_space_ += 3 * (longest + front_lanes);
}

template <typename Number> void Fronts::begin(std::uint32_t first, Memory<Number> &memory) const {
    const Mesh &mesh = mesh_of(first);
    std::fill(memory.panels.data() + fronts_[mesh.first].panel,
              memory.panels.data() + fronts_[mesh.last].panel, Number(0));
}

template <typename Number>
void Fronts::set(std::uint32_t block, std::size_t entry, const WideMatrix<Number> &value,
                 Memory<Number> &memory) const {
    const Front &front = fronts_[front_of_[block]];
    const FrontColumns<Number> panel = panel_of(front, memory);
    const std::size_t column = block - front.first;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            panel.at(3 * (column + entry), 3 * column + static_cast<std::size_t>(j))[i] =
                value[j][i];
}

template <typename Number>
void Fronts::factor(std::uint32_t first, std::span<WideMatrix<Number>> inverse_diagonal,
                    Memory<Number> &memory) const {
    const Mesh &mesh = mesh_of(first);
    for (std::uint32_t i = mesh.first; i < mesh.last; ++i) {
        const Front &front = fronts_[i];
        const FrontMatrix<Number> matrix{std::size_t{3} * front.count, panel_of(front, memory),
                                         rest_of(front, memory)};
        std::fill_n(matrix.rest.values, matrix.rest.size * matrix.rest.stride, Number(0));
        for (std::uint32_t c = front.children; c < fronts_[i + 1].children; ++c)
            kernels::add(rest_of(fronts_[children_[c]], memory), runs_of(children_[c]), matrix);
        for (std::uint32_t k = 0; k < front.count; ++k) {
            const auto inverse = inverse_at(matrix.panel, k);
            inverse_diagonal[front.first + k] = WideMatrix<Number>(inverse);
            kernels::eliminate(matrix, k, &inverse[0][0], memory.work.data() + mesh.pivots);
        }
    }
}

template <typename Number>
void Fronts::solve(std::uint32_t first, const FactorColumns &columns,
                   std::span<const WideMatrix<Number>> inverse_diagonal, Memory<Number> &memory,
                   std::span<WideVector<Number>> sides) const {
    const Mesh &mesh = mesh_of(first);
    Number *const dense = memory.work.data() + mesh.pivots; // a front's, 3 a block
    const auto put = [&](std::size_t row, const WideVector<Number> &value) {
        for (int k = 0; k < 3; ++k)
            dense[3 * row + static_cast<std::size_t>(k)] = value[k];
    };
    const auto get = [&](std::size_t row) {
        return WideVector<Number>(typename WideVector<Number>::Narrow{
            dense[3 * row], dense[3 * row + 1], dense[3 * row + 2]});
    };
    const auto own_sides = [&](const Front &front) {
        return sides.subspan(front.first - first, front.count);
    };
    const auto rows_of = [&](const Front &front) {
        return columns.of(front.first + front.count - 1);
    };
    const auto put_own = [&](const Front &front, const FrontColumns<Number> &panel) {
        std::fill_n(dense, panel.stride, Number(0));
        for (std::size_t k = 0; k < front.count; ++k)
            put(k, own_sides(front)[k]);
    };
    for (std::uint32_t i = mesh.first; i < mesh.last; ++i) {
        const Front &front = fronts_[i];
        const FrontColumns<Number> panel = panel_of(front, memory);
        put_own(front, panel);
        kernels::substitute(panel, std::size_t{3} * front.count, dense);
        for (std::size_t k = 0; k < front.count; ++k)
            own_sides(front)[k] = inverse_diagonal[front.first + k] * get(k);
        for (std::size_t k = 0; k < front.rows; ++k)
            sides[rows_of(front)[k] - first] += get(front.count + k);
    }
    for (std::uint32_t i = mesh.last; i-- > mesh.first;) {
        const Front &front = fronts_[i];
        const FrontColumns<Number> panel = panel_of(front, memory);
        put_own(front, panel);
        for (std::size_t k = 0; k < front.rows; ++k)
            put(front.count + k, sides[rows_of(front)[k] - first]);
        kernels::substitute_back(panel, std::size_t{3} * front.count, dense);
        for (std::size_t k = 0; k < front.count; ++k)
            own_sides(front)[k] = get(k);
    }
}

// NOLINTBEGIN(bugprone-macro-parentheses)
#define PLUMB_FRONTS_OF(Number)                                                                    \
    template void Fronts::begin(std::uint32_t, Memory<Number> &) const;                            \
    template void Fronts::set(std::uint32_t, std::size_t, const WideMatrix<Number> &,              \
                              Memory<Number> &) const;                                             \
    template void Fronts::factor(std::uint32_t, std::span<WideMatrix<Number>>, Memory<Number> &)   \
        const;                                                                                     \
    template void Fronts::solve(std::uint32_t, const FactorColumns &,                              \
                                std::span<const WideMatrix<Number>>, Memory<Number> &,             \
                                std::span<WideVector<Number>>) const;
// NOLINTEND(bugprone-macro-parentheses)
PLUMB_FRONTS_OF(float)
PLUMB_FRONTS_OF(double)
#undef PLUMB_FRONTS_OF

} // namespace plumb::inline PLUMB_PRECISION
