#include "engine/dynamics/joints/joint_system.h"

#include "engine/dynamics/joints/joint_impulse.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <utility>

#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Elimination products that a block may cost on average: a chain costs 1, a loop of a few joints 2,
// a shelf of five boards on welded posts 61, nets of 20, 30 and 40 balls a side 93, 152 and 202, a
// welded frame of 5 x 5 x 5 nodes 494. Gauss-Seidel is no cheaper where loads are large, as it
// needs up to 32 times the substeps; and its passes feed energy into loops of joints that hold
// angles.
constexpr std::size_t work_a_ball = 224;
constexpr std::size_t work_an_angle = 512;

// Elimination products a block from which on Gauss-Seidel could not hold a group that carries load.
constexpr std::size_t work_in_a_mesh = 16;

// Marks a target on the diagonal rather than among the entries; no target is both.
constexpr std::uint32_t on_diagonal = UINT32_C(1) << 31;

// Rigid rows that move something.
bool is_rigid(const JointConstraint &joint) {
    return joint.joint != JointConstraint::grab && joint.rows.bounds == RowBounds::equal &&
           !joint.is_spring() && (joint.moves_a || joint.moves_b);
}

} // namespace

void JointSystem::arrange(StepContext &context) {
    find_order(context);
    for (JointGroup &group : groups_)
        group.is_factored = group.is_touched = group.was_torn = group.was_let_go =
            group.has_changed = false;
    note_touched(context);
    note_stiff(context);
}

void JointSystem::note_touched(const StepContext &context) {
    const auto note = [&](std::uint32_t body) {
        if (group_of_body_[body] != none)
            groups_[group_of_body_[body]].is_touched = true;
    };
    if (groups_.empty())
        return;
    for (const std::uint32_t i : context.active.contacts) {
        note(context.ends[i].a);
        note(context.ends[i].b);
    }
    for (const ParticleContact &contact : context.particle_contacts)
        note(contact.body);
}

// A heavy bob on a light cart: what the light body's K is a share of would give way under the heavy
// one as if that were moved by hand. Not where more joints follow each other: a chain that whips
// would gain energy.
bool JointSystem::is_uneven(const StepContext &context, const JointGroup &group) const {
    constexpr Real unlike = Real(4);
    constexpr int few_joints = 2;
    int joints = 0;
    std::uint32_t last = JointConstraint::grab;
    Real least = std::numeric_limits<Real>::infinity(), greatest = Real(0);
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        const JointConstraint &joint = context.scratch.joints[order_[place]];
        joints += joint.joint == last ? 0 : 1;
        last = joint.joint;
        for (const auto &[body, moves] :
             {std::pair{joint.a, joint.moves_a}, std::pair{joint.b, joint.moves_b}})
            if (moves) {
                const Vec3 &inverse = context.bodies[body].inv_mass;
                const Real most = std::max({inverse.x, inverse.y, inverse.z});
                least = std::min(least, most);
                greatest = std::max(greatest, most);
            }
    }
    return joints <= few_joints && greatest > unlike * least;
}

// A point-like bob on a long arm, or a slender rod: what holds it is the small difference of large
// numbers.
void JointSystem::note_stiff(StepContext &context) {
    constexpr Real much_faster = Real(4000); // an arm's end by turning than the body by moving
    constexpr Real slender = Real(1000);     // one moment of inertia against another
    const auto is_stiff = [&](const JointConstraint &joint, std::uint32_t index, const Vec3 &arm) {
        const SolverBody &body = context.body(index);
        const Mat3 &inverse = body.inv_inertia;
        const Real trace = inverse[0][0] + inverse[1][1] + inverse[2][2];
        if (joint.rows.kind != RowKind::angular) // of K for a point, less the translation's share
            return trace * glm::dot(arm, arm) - glm::dot(arm, inverse * arm) >
                   much_faster * std::max({body.inv_mass.x, body.inv_mass.y, body.inv_mass.z});
        const Vec3 &inertia = context.model.bodies[index].inertia;
        return std::max({inertia.x, inertia.y, inertia.z}) >
               slender * std::min({inertia.x, inertia.y, inertia.z});
    };
    for (JointGroup &group : groups_) {
        group.is_uneven = is_uneven(context, group);
        group.is_stiff = group.is_uneven;
        for (std::uint32_t place = group.first; place < group.last && !group.is_stiff; ++place) {
            const JointConstraint &joint = context.scratch.joints[order_[place]];
            group.is_stiff = (joint.moves_a && is_stiff(joint, joint.a, joint.rows.r_a)) ||
                             (joint.moves_b && is_stiff(joint, joint.b, joint.rows.r_b));
        }
        if (group.is_stiff)
            fine_factors_.resize(order_.size(), rows_.size(), fronts_);
    }
}

template <typename Number>
void JointSystem::Factors<Number>::resize(std::size_t places, std::size_t entries,
                                          const Fronts &meshes) {
    effects.resize(places);
    diagonal.resize(places);
    sides.resize(places);
    lower.resize(entries);
    meshes.resize(fronts);
}

void JointSystem::find_order(StepContext &context) {
    std::vector<JointConstraint> &joints = context.scratch.joints;
    const auto is_dynamic = [&](std::uint32_t body) {
        return body != Joint::world && context.model.bodies[body].kind == BodyKind::dynamic;
    };
    // What the arrangement depends on: the bodies, and whether the rows are angles.
    const auto key_of = [&](const JointConstraint &joint) {
        const std::uint64_t a = is_dynamic(joint.a) ? joint.a : Joint::world;
        const std::uint64_t b = is_dynamic(joint.b) ? joint.b : Joint::world;
        const std::uint64_t is_angular = joint.rows.kind == RowKind::angular ? 1 : 0;
        return is_rigid(joint) ? is_angular << 63 | (a & 0x7FFFFFFFU) << 32 | b : ~std::uint64_t{0};
    };
    is_arranged_ = true;
    if (!key_.empty() && key_.front() == context.bodies.size() &&
        std::ranges::equal(std::span(key_).subspan(1), joints, {}, {}, key_of)) {
        context.scratch.sides.resize(std::max(context.scratch.sides.size(), order_.size()));
        return;
    }
    key_.assign(1, context.bodies.size());
    for (const JointConstraint &joint : joints)
        key_.push_back(key_of(joint));
    groups_.clear();
    order_.clear();
    column_start_.assign(1, 0);
    rows_.clear();
    targets_.clear();
    target_start_.assign(1, 0);
    fronts_.clear();
    group_of_body_.assign(context.bodies.size(), none);

    blocks_of_.resize(std::max(blocks_of_.size(), context.bodies.size())); // kept for their memory
    for (std::vector<std::uint32_t> &blocks : blocks_of_)
        blocks.clear();
    ends_.assign(joints.size(), {none, none});
    costs_.resize(joints.size());
    shared_.assign(context.bodies.size(), 0);
    for (std::uint32_t i = 0; i < joints.size(); ++i) {
        if (!is_rigid(joints[i]))
            continue;
        auto end = ends_[i].begin();
        for (const std::uint32_t body : {joints[i].a, joints[i].b})
            if (is_dynamic(body)) {
                blocks_of_[body].push_back(i);
                *end++ = body;
            }
    }
    std::vector<std::uint8_t> is_seen(joints.size(), 0);
    std::vector<std::uint32_t> members;
    place_of_.resize(joints.size());
    for (std::uint32_t seed = 0; seed < joints.size(); ++seed) {
        if (is_seen[seed] != 0 || !is_rigid(joints[seed]))
            continue;
        members.assign(1, seed);
        is_seen[seed] = 1;
        for (std::size_t next = 0; next < members.size(); ++next)
            for (const std::uint32_t body : ends_[members[next]])
                if (body != none)
                    for (const std::uint32_t other : blocks_of_[body])
                        if (std::exchange(is_seen[other], std::uint8_t{1}) == 0)
                            members.push_back(other);
        const bool has_angles = std::ranges::any_of(members, [&](std::uint32_t member) {
            return joints[member].rows.kind == RowKind::angular;
        });
        if (!eliminate(members, has_angles ? work_an_angle : work_a_ball))
            continue;
        for (const std::uint32_t member : members)
            for (const std::uint32_t body : {joints[member].a, joints[member].b})
                if (is_dynamic(body))
                    group_of_body_[body] = static_cast<std::uint32_t>(groups_.size() - 1);
    }
    find_couplings(context);
    context.scratch.sides.resize(std::max(context.scratch.sides.size(), order_.size()));
    softening_.resize(order_.size());
    factors_.resize(order_.size(), rows_.size(), fronts_);
}

void JointSystem::find_couplings(const StepContext &context) {
    const std::vector<JointConstraint> &joints = context.scratch.joints;
    const auto shares_body = [&](std::uint32_t place, std::uint32_t other) {
        const JointConstraint &one = joints[order_[place]];
        const auto has = [&](std::uint32_t body) {
            return body != Joint::world &&
                   (body == joints[order_[other]].a || body == joints[order_[other]].b);
        };
        return has(one.a) || has(one.b);
    };
    couplings_.clear();
    coupling_start_.assign(1, 0);
    for (std::uint32_t place = 0; place < order_.size(); ++place) {
        for (std::uint32_t i = column_start_[place]; i < column_start_[place + 1]; ++i)
            if (shares_body(place, rows_[i]))
                couplings_.push_back(i);
        coupling_start_.push_back(static_cast<std::uint32_t>(couplings_.size()));
    }
}

// Rates the blocks at a body by how many pairs of others each would couple anew, if eliminated.
void JointSystem::rate_blocks(std::uint32_t body) {
    const std::vector<std::uint32_t> &blocks = blocks_of_[body];
    const auto other_end = [&](std::uint32_t block) {
        std::array<std::uint32_t, 2> &ends = ends_[block];
        if (ends[0] != body)
            std::swap(ends[0], ends[1]);
        return ends[1];
    };
    for (const std::uint32_t block : blocks)
        if (const std::uint32_t other = other_end(block); other != none)
            ++shared_[other];
    for (const std::uint32_t block : blocks) {
        const std::uint32_t other = other_end(block);
        Cost cost{.pairs = 0, .degree = blocks.size() - 1, .block = block};
        if (other != none) {
            const std::size_t there = blocks_of_[other].size(), both = shared_[other];
            cost.pairs = static_cast<double>((blocks.size() - both) * (there - both)) /
                         static_cast<double>(both);
            cost.degree += there - both;
        }
        costs_[block] = cost;
        queue_.push_back(cost);
        std::ranges::push_heap(queue_, std::ranges::greater{});
    }
    for (const std::uint32_t block : blocks)
        if (const std::uint32_t other = other_end(block); other != none)
            shared_[other] = 0;
}

// Makes the bodies of a block one, without it; returns that.
std::uint32_t JointSystem::merge_ends(std::uint32_t block) {
    auto [kept, gone] = ends_[block];
    if (gone != none && blocks_of_[kept].size() < blocks_of_[gone].size())
        std::swap(kept, gone);
    std::erase(blocks_of_[kept], block);
    if (gone == none)
        return kept;
    for (const std::uint32_t other : blocks_of_[gone]) {
        if (other == block)
            continue;
        const auto [a, b] = ends_[other];
        if (a == kept || b == kept) {
            ends_[other] = {kept, none};
        } else {
            ends_[other] = {kept, a == gone ? b : a};
            blocks_of_[kept].push_back(other);
        }
    }
    blocks_of_[gone].clear();
    return kept;
}

// Orders one group by least fill-in and finds that; returns false, with nothing done, when a block
// would cost more than so much on average.
//
// A block is coupled with all others at its bodies. Eliminating it couples those with each other,
// as if its bodies were one. So every block keeps two ends at most, and how many pairs it would
// couple anew follows from how many blocks are at each: an estimate, as some of them may be coupled
// already (Rothberg and Eisenstat 1998, "Node Selection Strategies for Bottom-Up Sparse Matrix
// Ordering"). Blocks between the same two bodies share them, as after the first the others couple
// none. For a net of 40 by 40 this takes 202 products a block, where minimum degree takes 503.
bool JointSystem::eliminate(const std::vector<std::uint32_t> &members, std::size_t work_a_block) {
    const auto first = static_cast<std::uint32_t>(order_.size());
    queue_.clear();
    for (const std::uint32_t member : members)
        for (const std::uint32_t body : std::array(ends_[member]))
            if (body != none && blocks_of_[body].front() == member) // each body once
                rate_blocks(body);
    std::size_t work = 0;
    while (!queue_.empty()) {
        std::ranges::pop_heap(queue_, std::ranges::greater{});
        const Cost cost = queue_.back();
        queue_.pop_back();
        if (cost != costs_[cost.block])
            continue; // has been rated again, or is done
        work += cost.degree * (cost.degree + 1) / 2;
        if (work > work_a_block * members.size()) {
            order_.resize(first);
            column_start_.resize(first + 1);
            rows_.resize(column_start_.back());
            return false;
        }
        costs_[cost.block].block = none;
        const std::uint32_t body = merge_ends(cost.block);
        order_.push_back(cost.block);
        rows_.insert(rows_.end(), blocks_of_[body].begin(), blocks_of_[body].end());
        column_start_.push_back(static_cast<std::uint32_t>(rows_.size()));
        rate_blocks(body);
    }

    const auto last = static_cast<std::uint32_t>(order_.size());
    for (std::uint32_t place = first; place < last; ++place)
        place_of_[order_[place]] = place;
    const bool is_mesh = work > work_in_a_mesh * members.size();
    if (is_mesh)
        order_by_tree(first);
    for (std::uint32_t place = first; place < last; ++place) {
        const auto column = std::span(rows_).subspan(
            column_start_[place], column_start_[place + 1] - column_start_[place]);
        for (std::uint32_t &row : column)
            row = place_of_[row];
        std::ranges::sort(column);
    }
    if (is_mesh)
        fronts_.add(first, last, columns());
    for (std::uint32_t place = first; place < last; ++place) {
        for (std::uint32_t i = column_start_[place]; !is_mesh && i < column_start_[place + 1];
             ++i) {
            targets_.push_back(rows_[i] | on_diagonal);
            const auto begin = rows_.begin() + column_start_[rows_[i]];
            const auto end = rows_.begin() + column_start_[rows_[i] + 1];
            for (std::uint32_t j = i + 1; j < column_start_[place + 1]; ++j)
                targets_.push_back(static_cast<std::uint32_t>(
                    std::lower_bound(begin, end, rows_[j]) - rows_.begin()));
        }
        target_start_.push_back(static_cast<std::uint32_t>(targets_.size()));
    }
    groups_.push_back({.first = first, .last = last, .is_mesh = is_mesh});
    return true;
}

// Puts the blocks from `first` on into a postorder of their elimination tree: with the same
// fill-in, columns with the same rows stand next to each other (Liu 1990, "The Role of Elimination
// Trees in Sparse Factorization", 2.3).
void JointSystem::order_by_tree(std::uint32_t first) {
    constexpr std::uint32_t no_place = UINT32_MAX;
    const auto count = static_cast<std::uint32_t>(order_.size()) - first;
    const auto rows_of = [&](std::uint32_t i) { return columns().of(first + i); };
    // The parent is the first row. A child that leaves out none of its parent's other rows comes
    // next to it.
    std::vector<std::uint32_t> parent(count, no_place), last_child(count, no_place),
        sibling(count, no_place), closest(count, no_place);
    for (std::uint32_t i = 0; i < count; ++i) {
        for (const std::uint32_t row : rows_of(i))
            parent[i] = std::min(parent[i], place_of_[row] - first);
        if (parent[i] != no_place && rows_of(i).size() == rows_of(parent[i]).size() + 1)
            closest[parent[i]] = i;
    }
    for (std::uint32_t i = 0; i < count; ++i)
        if (parent[i] != no_place && closest[parent[i]] != i)
            sibling[i] = std::exchange(last_child[parent[i]], i);
    for (std::uint32_t i = 0; i < count; ++i)
        if (closest[i] != no_place)
            sibling[closest[i]] = std::exchange(last_child[i], closest[i]);
    std::vector<std::uint32_t> backwards; // parents first, their last child next
    std::vector<std::uint32_t> open;
    for (std::uint32_t root = 0; root < count; ++root) {
        if (parent[root] != no_place)
            continue;
        open.assign(1, root);
        while (!open.empty()) {
            const std::uint32_t i = open.back();
            open.pop_back();
            backwards.push_back(i);
            // The last one pushed is the next.
            const std::size_t begin = open.size();
            for (std::uint32_t child = last_child[i]; child != no_place; child = sibling[child])
                open.push_back(child);
            std::reverse(open.begin() + static_cast<std::ptrdiff_t>(begin), open.end());
        }
    }
    std::vector<std::uint32_t> order(order_.begin(), order_.begin() + first);
    std::vector<std::uint32_t> rows(rows_.begin(), rows_.begin() + column_start_[first]);
    std::vector<std::uint32_t> start(column_start_.begin(), column_start_.begin() + first + 1);
    for (std::uint32_t k = count; k-- > 0;) {
        const std::span column = rows_of(backwards[k]);
        order.push_back(order_[first + backwards[k]]);
        rows.insert(rows.end(), column.begin(), column.end());
        start.push_back(static_cast<std::uint32_t>(rows.size()));
    }
    order_ = std::move(order);
    rows_ = std::move(rows);
    column_start_ = std::move(start);
    for (std::uint32_t place = first; place < order_.size(); ++place)
        place_of_[order_[place]] = place;
}

template <typename Number>
void JointSystem::find_effect(StepContext &context, const JointConstraint &joint, bool is_b,
                              Effect<Number> &out) {
    out.body = is_b ? joint.b : joint.a;
    if (out.body == Joint::world)
        return;
    const RowBlock &rows = joint.rows;
    const SolverBody &body = context.bodies[out.body];
    out.is_linear = rows.kind != RowKind::angular;
    out.is_point = rows.kind == RowKind::point;
    out.sign = is_b ? Number(1) : Number(-1);
    out.arm = out.sign * WideVector<Number>(WideVec3(is_b ? rows.r_b : rows.r_a));
    out.inv_mass = WideVector<Number>(WideVec3::followed(body.inv_mass));
    const WideMatrix<Number> inverse(WideMat3::followed(body.inv_inertia));
    if (out.is_point) {
        const WideVector<Number> &arm = out.arm;
        out.turned = {arm[2] * inverse[1] - arm[1] * inverse[2],
                      arm[0] * inverse[2] - arm[2] * inverse[0],
                      arm[1] * inverse[0] - arm[0] * inverse[1]};
        return;
    }
    out.linear = out.angular = out.moved = WideMatrix<Number>{};
    for (int i = 0; i < rows.count; ++i) {
        const WideVector<Number> axis(WideVec3(rows.axes[static_cast<std::size_t>(i)]));
        out.angular[i] = out.is_linear ? cross(out.arm, axis) : out.sign * axis;
        if (out.is_linear) {
            out.linear[i] = out.sign * axis;
            out.moved[i] = out.inv_mass * out.linear[i];
        }
    }
    for (int i = 0; i < 3; ++i)
        out.turned[i] = inverse * out.angular[i];
}

// u^T M^-1 v for one body; `u` gives the rows of the result.
template <typename Number>
void JointSystem::add_coupling(const Effect<Number> &u, const Effect<Number> &v,
                               WideMatrix<Number> &sum) {
    for (int i = 0; i < 3; ++i)
        // The transpose of a cross product's matrix is its negative.
        sum[i] += u.is_point ? cross(v.turned[i], u.arm) : u.angular.transposed_times(v.turned[i]);
    if (!u.is_linear || !v.is_linear)
        return;
    if (u.is_point && v.is_point) {
        sum.add_diagonal(((u.sign * v.sign) * u.inv_mass).narrow());
    } else if (v.is_point) {
        const WideMatrix<Number> moved = u.moved.transposed();
        for (int i = 0; i < 3; ++i)
            sum[i] += v.sign * moved[i];
    } else if (u.is_point) {
        for (int i = 0; i < 3; ++i)
            sum[i] += u.sign * v.moved[i];
    } else {
        for (int i = 0; i < 3; ++i)
            sum[i] += u.linear.transposed_times(v.moved[i]);
    }
}

template <typename Number>
void JointSystem::factor(StepContext &context, const JointGroup &group, Number compliance,
                         Number rounding, Factors<Number> &into) {
    const std::vector<JointConstraint> &joints = context.scratch.joints;
    auto &[effects, diagonal, lower, sides, fronts] = into;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        const JointConstraint &joint = joints[order_[place]];
        find_effect(context, joint, false, effects[place][0]);
        find_effect(context, joint, true, effects[place][1]);
    }
    if (group.is_mesh)
        fronts_.begin(group.first, fronts);
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        const JointConstraint &joint = joints[order_[place]];
        const int count = joint.rows.count;
        WideMatrix<Number> own;
        for (const Effect<Number> &effect : effects[place])
            if (effect.body != Joint::world)
                add_coupling(effect, effect, own);
        const Number size = (own[0][0] + own[1][1] + own[2][2]) / static_cast<Number>(count);
        auto all = own.narrow();
        for (int i = count; i < 3; ++i)
            all[i][i] = size;
        typename WideVector<Number>::Narrow for_rounding{Number(0)};
        typename WideVector<Number>::Narrow missing{Number(1)}; // rows that are not there
        for (int i = 0; i < count; ++i) {
            for_rounding[i] = rounding * size;
            if (size > Number(0))
                missing[i] = Number(0);
        }
        WideMatrix<Number> softening;
        if (may_be_locked(context.body(joint.a), context.body(joint.b)))
            softening = WideMatrix<Number>(WideMatrix<double>(locked_compliance(glm::dmat3(all))));
        for (int i = 0; i < 3; ++i)
            softening[i] += compliance * own[i];
        softening.add_diagonal(for_rounding);
        softening_[place] = WideMat3(softening);
        own += softening;
        own.add_diagonal(missing);
        if (group.is_mesh) {
            fronts_.set(place, 0, own, fronts);
        } else {
            diagonal[place] = own;
            std::fill(lower.begin() + column_start_[place],
                      lower.begin() + column_start_[place + 1], WideMatrix<Number>{});
        }
        for (std::uint32_t k = coupling_start_[place]; k < coupling_start_[place + 1]; ++k) {
            const std::uint32_t i = couplings_[k];
            WideMatrix<Number> coupling;
            for (const Effect<Number> &u : effects[rows_[i]])
                for (const Effect<Number> &v : effects[place])
                    if (u.body == v.body && u.body != Joint::world)
                        add_coupling(u, v, coupling);
            if (group.is_mesh)
                fronts_.set(place, i - column_start_[place] + 1, coupling, fronts);
            else
                lower[i] = coupling;
        }
    }
    if (group.is_mesh) {
        fronts_.factor<Number>(group.first, diagonal, fronts);
        return;
    }
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        const WideMatrix<Number> inverse(glm::inverse(diagonal[place].narrow()));
        diagonal[place] = inverse;
        const std::uint32_t end = column_start_[place + 1];
        const std::uint32_t *target = targets_.data() + target_start_[place];
        for (std::uint32_t i = column_start_[place]; i < end; ++i) {
            // Row i of L; the rows after it are still K's.
            WideMatrix<Number> row;
            row.add_product(lower[i], inverse);
            const WideMatrix<Number> across = -row.transposed();
            for (std::uint32_t j = i; j < end; ++j, ++target)
                ((*target & on_diagonal) != 0 ? diagonal[*target & ~on_diagonal] : lower[*target])
                    .add_product(lower[j], across);
            lower[i] = row;
        }
    }
}

void JointSystem::factor(StepContext &context, const JointGroup &group) {
    constexpr Real rounding = Real(1e-5); // of K, as a share of its trace
    constexpr double fine_rounding = 1e-10;
    if (group.is_stiff)
        factor(context, group, stiff_compliance, fine_rounding, fine_factors_);
    else
        factor(context, group, held_compliance, rounding, factors_);
}

template <typename Number>
void JointSystem::solve(const JointGroup &group, Factors<Number> &factors,
                        std::span<WideVector<Number>> sides) const {
    if (group.is_mesh) {
        fronts_.solve<Number>(group.first, columns(), factors.diagonal, factors.fronts, sides);
        return;
    }
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        WideVector<Number> &own = sides[place - group.first];
        for (std::uint32_t i = column_start_[place]; i < column_start_[place + 1]; ++i)
            sides[rows_[i] - group.first] -= factors.lower[i] * own;
        own = factors.diagonal[place] * own;
    }
    for (std::uint32_t place = group.last; place-- > group.first;)
        for (std::uint32_t i = column_start_[place]; i < column_start_[place + 1]; ++i)
            sides[place - group.first] -=
                factors.lower[i].transposed_times(sides[rows_[i] - group.first]);
}

void JointSystem::solve(const JointGroup &group, std::span<WideVec3> sides) const {
    if (!group.is_stiff) {
        solve(group, factors_, sides);
        return;
    }
    const std::span fine =
        std::span(fine_factors_.sides).subspan(group.first, group.last - group.first);
    for (std::size_t i = 0; i < fine.size(); ++i)
        fine[i] = WideVector<double>(sides[i]);
    solve(group, fine_factors_, fine);
    for (std::size_t i = 0; i < fine.size(); ++i)
        sides[i] = WideVec3(fine[i]);
}

} // namespace plumb::inline PLUMB_PRECISION
