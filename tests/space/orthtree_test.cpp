#include "engine/space/orthtree.h"

#include "engine/core/random.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();
constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());
using W = long double;

template <int Dim> using PointOf = typename Orthtree<Dim>::Point;
template <int Dim> using BoxOf = typename Orthtree<Dim>::Box;

Real any_real(Random &random, double low, double high) {
    return static_cast<Real>(random.next_in(low, high));
}

template <int Dim> PointOf<Dim> any_point(Random &random, double reach) {
    PointOf<Dim> p{Real(0)};
    for (int i = 0; i < Dim; ++i)
        p[i] = any_real(random, -reach, reach);
    return p;
}

template <int Dim> BoxOf<Dim> world() {
    return {PointOf<Dim>{Real(-64)}, PointOf<Dim>{Real(64)}};
}

// Boxes of all sizes from points to larger than the world, mostly small; some on dividing planes,
// outside the world, or with integer coordinates, so that many touch.
template <int Dim> BoxOf<Dim> any_box(Random &random) {
    const std::uint32_t kind = random.next_index(8);
    PointOf<Dim> center = any_point<Dim>(random, 64.0);
    PointOf<Dim> half{Real(0)};
    const double size = std::pow(10.0, random.next_in(-3.0, 1.0));
    for (int i = 0; i < Dim; ++i) {
        half[i] = static_cast<Real>(size * random.next_unit());
        if (kind == 0) {
            center[i] = Real(8) * std::round(center[i] / Real(8));
        } else if (kind <= 2) {
            center[i] = std::round(center[i]);
            half[i] = Real(random.next_index(4));
        }
    }
    if (kind == 3)
        half = PointOf<Dim>{Real(0)};
    if (kind == 4 && random.next_index(4) == 0)
        center *= Real(1000);
    if (kind == 5 && random.next_index(4) == 0)
        half *= Real(100);
    return {center - half, center + half};
}

template <int Dim> bool touch(const BoxOf<Dim> &a, const BoxOf<Dim> &b) {
    bool result = true;
    for (int i = 0; i < Dim; ++i)
        result = result && std::max(a.min[i], b.min[i]) <= std::min(a.max[i], b.max[i]);
    return result;
}

template <int Dim> W distance(const BoxOf<Dim> &box, const PointOf<Dim> &p) {
    W sum = 0;
    for (int i = 0; i < Dim; ++i) {
        const W d = W(p[i]) - std::clamp(W(p[i]), W(box.min[i]), W(box.max[i]));
        sum += d * d;
    }
    return std::sqrt(sum);
}

// The t in [0, max_t] at which origin + t * direction enters a box grown by `grow`.
template <int Dim>
std::optional<W> entry(const BoxOf<Dim> &box, const PointOf<Dim> &origin,
                       const PointOf<Dim> &direction, W max_t, W grow) {
    W enter = 0, exit = max_t;
    for (int i = 0; i < Dim; ++i) {
        const W low = W(box.min[i]) - grow - W(origin[i]);
        const W high = W(box.max[i]) + grow - W(origin[i]);
        const W d = W(direction[i]);
        if (d == 0) {
            if (low > 0 || high < 0)
                return std::nullopt;
            continue;
        }
        enter = std::max(enter, std::min(low / d, high / d));
        exit = std::min(exit, std::max(low / d, high / d));
    }
    if (enter > exit)
        return std::nullopt;
    return enter;
}

// A tree and a list of the same items, which must agree.
template <int Dim> class Checked {
  public:
    // Grows to `most` items, then shrinks to a fifteenth of that.
    Checked(int max_depth, int capacity, std::size_t most, std::uint64_t seed)
        : tree_(world<Dim>(), max_depth, capacity), max_depth_(max_depth), capacity_(capacity),
          most_(most), random_(seed) {}

    void change() {
        const std::uint32_t what = random_.next_index(100);
        // Grows and shrinks in turn, so that cells split and merge.
        is_growing_ =
            items_.empty() || (is_growing_ ? items_.size() < most_ : items_.size() < most_ / 15);
        if (items_.empty() || (what < 50 && is_growing_) || what < 15) {
            const BoxOf<Dim> box = any_box<Dim>(random_);
            std::uint32_t user = std::uint32_t(items_.size());
            if (!free_users_.empty()) {
                user = free_users_.back();
                free_users_.pop_back();
            }
            items_.push_back({tree_.insert(box, user), user, box});
        } else if (what < 65) {
            const std::size_t i = any_index();
            tree_.remove(items_[i].item);
            free_users_.push_back(items_[i].user);
            items_[i] = items_.back();
            items_.pop_back();
        } else {
            Item &item = items_[any_index()];
            if (random_.next_index(2) == 0) {
                item.box = any_box<Dim>(random_);
            } else { // a small move
                const PointOf<Dim> by = any_point<Dim>(random_, 0.1);
                item.box.min += by;
                item.box.max += by;
                item.box.max = glm::max(item.box.max, item.box.min);
            }
            tree_.update(item.item, item.box);
        }
    }

    void check_items() const {
        tree_.validate();
        ASSERT_EQ(tree_.size(), items_.size());
        for (const Item &item : items_) {
            ASSERT_EQ(tree_.user(item.item), item.user);
            ASSERT_EQ(tree_.bounds(item.item).min, item.box.min);
            ASSERT_EQ(tree_.bounds(item.item).max, item.box.max);
        }
    }

    // The cells must equal those of a tree built from scratch.
    void check_cells() const {
        Orthtree<Dim> fresh(world<Dim>(), max_depth_, capacity_);
        for (const Item &item : items_)
            fresh.insert(item.box, item.user);
        const auto list = [](const Orthtree<Dim> &tree) {
            std::vector<std::tuple<Real, Real, int, std::size_t>> cells;
            tree.cells([&](const BoxOf<Dim> &box, int depth, std::size_t count) {
                cells.emplace_back(box.min[0], box.max[Dim - 1], depth, count);
            });
            return cells;
        };
        ASSERT_EQ(list(tree_), list(fresh));
    }

    void check_box_query() {
        BoxOf<Dim> box = any_box<Dim>(random_);
        if (random_.next_index(16) == 0)
            std::swap(box.min, box.max); // empty, or a point
        const bool is_empty_box = !touch<Dim>(box, box);
        check_found([&](auto &&visit) { tree_.query(box, visit); },
                    [&](const Item &item) { return !is_empty_box && touch<Dim>(item.box, box); });
    }

    void check_ball_query() {
        typename Orthtree<Dim>::Ball ball;
        ball.center = any_point<Dim>(random_, 80.0);
        ball.radius = static_cast<Real>(std::pow(10.0, random_.next_in(-2.0, 2.0)));
        check_found([&](auto &&visit) { tree_.query(ball, visit); },
                    [&](const Item &item) {
                        // A sum of squared differences: 4 roundings.
                        const W d = distance<Dim>(item.box, ball.center) - W(ball.radius);
                        return std::abs(d) <= 2 * W(epsilon) * W(ball.radius)
                                   ? std::nullopt
                                   : std::optional(d < 0);
                    });
    }

    void check_line_query() {
        const typename Orthtree<Dim>::Line line = any_line();
        check_found([&](auto &&visit) { tree_.query(line, visit); },
                    [&](const Item &item) -> std::optional<bool> {
                        const W length = std::sqrt(W(glm::dot(line.b - line.a, line.b - line.a)));
                        // A line that meets the box exactly must be found. One that misses it by
                        // more than the rounding of b - a must not.
                        if (meets(item.box, line.a, line.b, 0))
                            return true;
                        if (!meets(item.box, line.a, line.b, 8 * W(epsilon) * (length + 130)))
                            return false;
                        return std::nullopt;
                    });
    }

    void check_region_query() {
        const PointOf<Dim> n = any_point<Dim>(random_, 1.0);
        const Real offset = any_real(random_, -40.0, 40.0);
        const auto is_in = [&](const BoxOf<Dim> &box) {
            Real least = Real(0);
            for (int i = 0; i < Dim; ++i)
                least += n[i] * (n[i] > Real(0) ? box.min[i] : box.max[i]);
            return least <= offset;
        };
        check_found([&](auto &&visit) { tree_.query_if(is_in, visit); },
                    [&](const Item &item) { return is_in(item.box); });
    }

    void check_raycast() {
        const typename Orthtree<Dim>::Line line = any_line();
        const PointOf<Dim> a = line.a;
        const PointOf<Dim> b = line.b;
        if (a == b)
            return;
        const PointOf<Dim> d = b - a;
        const Real max_t = random_.next_index(2) == 0 ? infinity : Real(1);
        const auto t_of = [&](const BoxOf<Dim> &box, Real limit) {
            const std::optional<W> t = entry<Dim>(box, a, d, W(limit), 0);
            return t ? std::optional(static_cast<Real>(*t)) : std::nullopt;
        };
        Real expected = infinity;
        for (const Item &item : items_)
            expected = std::min(expected, t_of(item.box, max_t).value_or(infinity));

        Real closest = infinity;
        std::size_t visits = 0;
        tree_.raycast({a, d, max_t}, [&](std::uint32_t user, const auto &ray) {
            ++visits;
            const std::optional<Real> t = t_of(box_of(user), ray.max_t);
            if (!t)
                return ray.max_t;
            closest = std::min(closest, *t);
            return *t;
        });
        ASSERT_LE(visits, items_.size());
        if (expected == infinity) {
            ASSERT_EQ(closest, infinity);
        } else {
            // Rounding up a cell's entry may hide another hit equally near.
            ASSERT_NEAR(double(closest), double(expected), 4 * epsilon * double(expected));
        }
        // Any hit: the first visit that hits ends the search.
        bool any = false;
        bool goes_on = false;
        tree_.raycast({a, d, max_t}, [&](std::uint32_t user, const auto &ray) {
            goes_on = goes_on || any;
            any = t_of(box_of(user), max_t).has_value();
            return any ? Real(0) : ray.max_t;
        });
        ASSERT_EQ(any, expected < infinity);
        ASSERT_FALSE(goes_on);
        hits_ += any ? 1 : 0;
    }

    void check_closest() {
        const PointOf<Dim> p = any_point<Dim>(random_, random_.next_index(8) == 0 ? 1e4 : 80.0);
        const bool leaves_out = random_.next_index(2) == 0;
        const auto distance_of = [&](std::uint32_t user, const BoxOf<Dim> &box) {
            if (leaves_out && user % 3 != 0)
                return infinity;
            return static_cast<Real>(distance<Dim>(box, p));
        };
        std::pair<Real, std::uint32_t> expected{infinity, 0};
        for (const Item &item : items_)
            expected = std::min(expected, {distance_of(item.user, item.box), item.user});
        const auto found =
            tree_.closest(p, [&](std::uint32_t user) { return distance_of(user, box_of(user)); });
        ASSERT_EQ(found.has_value(), expected.first < infinity);
        if (found) {
            ASSERT_EQ(found->distance, expected.first);
            ASSERT_EQ(found->user, expected.second);
        }
    }

    void check_pairs() {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> found, expected;
        tree_.pairs([&](std::uint32_t a, std::uint32_t b) { found.push_back(std::minmax(a, b)); });
        for (std::size_t i = 0; i < items_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (touch<Dim>(items_[i].box, items_[j].box))
                    expected.push_back(std::minmax(items_[i].user, items_[j].user));
        std::sort(found.begin(), found.end());
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(found, expected);
    }

    std::size_t hits() const { return hits_; }

  private:
    struct Item {
        typename Orthtree<Dim>::Item item = 0;
        std::uint32_t user = 0;
        BoxOf<Dim> box;
    };

    std::size_t any_index() {
        return random_.next_index(static_cast<std::uint32_t>(items_.size()));
    }

    const BoxOf<Dim> &box_of(std::uint32_t user) const {
        return std::find_if(items_.begin(), items_.end(),
                            [&](const Item &item) { return item.user == user; })
            ->box;
    }

    // Some lie along an axis or in faces of boxes; some are points.
    typename Orthtree<Dim>::Line any_line() {
        PointOf<Dim> a = any_point<Dim>(random_, 90.0);
        PointOf<Dim> b = any_point<Dim>(random_, 90.0);
        const std::uint32_t kind = random_.next_index(4);
        if (kind == 0 && !items_.empty()) {
            const BoxOf<Dim> &box = items_[any_index()].box;
            b = random_.next_index(2) == 0 ? box.min : box.max; // through a corner, or ending there
        } else if (kind == 1) {
            a = glm::round(a);
            const int axis = static_cast<int>(random_.next_index(Dim));
            const Real far = b[axis];
            b = a;
            b[axis] = random_.next_index(8) == 0 ? a[axis] : far;
        }
        return {a, b};
    }

    bool meets(const BoxOf<Dim> &box, const PointOf<Dim> &a, const PointOf<Dim> &b, W grow) const {
        // Clipped in long double, without rounding b - a to Real.
        W enter = 0, exit = 1;
        for (int i = 0; i < Dim; ++i) {
            const W low = W(box.min[i]) - grow - W(a[i]);
            const W high = W(box.max[i]) + grow - W(a[i]);
            const W d = W(b[i]) - W(a[i]);
            if (d == 0) {
                if (low > 0 || high < 0)
                    return false;
                continue;
            }
            enter = std::max(enter, std::min(low / d, high / d));
            exit = std::min(exit, std::max(low / d, high / d));
        }
        return enter <= exit;
    }

    // Each item that must be found is found once, and none that must not be. `must` may return
    // nullopt for either.
    template <typename Query, typename Must> void check_found(Query &&query, Must &&must) {
        found_.assign(items_.size() + free_users_.size(), 0);
        query([&](std::uint32_t user) {
            ++found_[user];
            return true;
        });
        std::size_t count = 0;
        for (const Item &item : items_) {
            const std::optional<bool> expected = must(item);
            const int times = found_[item.user];
            count += static_cast<std::size_t>(times);
            if (expected) {
                ASSERT_EQ(times, *expected ? 1 : 0) << "user " << item.user;
            } else {
                ASSERT_LE(times, 1);
            }
        }
        hits_ += count;
        ASSERT_EQ(count, std::size_t(std::count(found_.begin(), found_.end(), 1)));
        std::size_t visits = 0;
        const std::size_t enough = 1 + random_.next_index(3);
        query([&](std::uint32_t) { return ++visits < enough; });
        ASSERT_EQ(visits, std::min(count, enough));
    }

    Orthtree<Dim> tree_;
    int max_depth_;
    int capacity_;
    std::size_t most_;
    Random random_;
    std::vector<Item> items_;
    std::vector<std::uint32_t> free_users_;
    bool is_growing_ = true;
    std::vector<int> found_;
    std::size_t hits_ = 0;
};

template <int Dim> void check_streams() {
    constexpr std::array<std::array<int, 2>, 5> settings{{{0, 1}, {3, 4}, {6, 8}, {16, 1}, {8, 2}}};
    for (const auto &[max_depth, capacity] : settings) {
        Checked<Dim> checked(max_depth, capacity, 300, 0x0c7 + std::uint64_t(max_depth));
        const int count = trials(60'000);
        for (int step = 0; step < count; ++step) {
            checked.change();
            switch (step % 8) {
            case 0:
                checked.check_box_query();
                break;
            case 1:
                checked.check_ball_query();
                break;
            case 2:
                checked.check_line_query();
                break;
            case 3:
                checked.check_region_query();
                break;
            case 4:
                checked.check_raycast();
                break;
            case 5:
                checked.check_closest();
                break;
            default:
                break;
            }
            if (step % 256 == 0) {
                checked.check_items();
                checked.check_cells();
                checked.check_pairs();
            }
            if (::testing::Test::HasFatalFailure())
                FAIL() << "step " << step << " of max_depth " << max_depth << ", capacity "
                       << capacity;
        }
        EXPECT_GT(checked.hits(), std::size_t(count));
    }
}

TEST(Orthtree, QuadtreeAgreesWithAList) {
    check_streams<2>();
}

TEST(Orthtree, OctreeAgreesWithAList) {
    check_streams<3>();
}

// A million of each change and query: few items, so that the list is fast.
template <int Dim> void check_a_million() {
    Checked<Dim> checked(6, 1, 15, 0x0c9);
    const int count = trials(1'000'000);
    for (int step = 0; step < count; ++step) {
        for (int change = 0; change < 4; ++change) // a third of them are insertions
            checked.change();
        checked.check_box_query();
        checked.check_ball_query();
        checked.check_line_query();
        checked.check_region_query();
        checked.check_raycast();
        checked.check_closest();
        checked.check_pairs();
        if (step % 256 == 0) {
            checked.check_items();
            checked.check_cells();
        }
        ASSERT_FALSE(testing::Test::HasFatalFailure()) << "step " << step;
    }
    EXPECT_GT(checked.hits(), std::size_t(count));
}

TEST(Orthtree, QuadtreeAnswersAMillionOfEach) {
    check_a_million<2>();
}

TEST(Orthtree, OctreeAnswersAMillionOfEach) {
    check_a_million<3>();
}

TEST(Orthtree, SmallThingsOnADividingPlaneAreNotAtTheTop) {
    Quadtree tree({Vec2{Real(-64)}, Vec2{Real(64)}}, 8, 4);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Vec2 p{Real(0), Real(-60) + Real(i) * Real(0.12)};
        tree.insert({p - Real(0.01), p + Real(0.01)}, i);
    }
    std::size_t tested = 0;
    tree.query_if(
        [&](const Rectangle &box) {
            ++tested;
            return box.min.y <= Real(10.1) && box.max.y >= Real(10);
        },
        [](std::uint32_t) { return true; });
    EXPECT_LT(tested, 60U);
}

TEST(Orthtree, WhatIsOutsideOfTheWorldIsFound) {
    Octree tree({Vec3{Real(-1)}, Vec3{Real(1)}}, 4, 1);
    const Vec3 far{Real(1e5), Real(-1e5), Real(3)};
    for (std::uint32_t i = 0; i < 10; ++i)
        tree.insert({Vec3{Real(0.1) * Real(i) - Real(0.5)}, Vec3{Real(0.1) * Real(i) - Real(0.5)}},
                    i);
    tree.insert({far, far + Real(1)}, 77);
    std::vector<std::uint32_t> found;
    const auto note = [&](std::uint32_t user) {
        found.push_back(user);
        return true;
    };
    tree.query(Aabb{far, far}, note);
    tree.query(Sphere{far - Real(1), Real(2)}, note);
    tree.query(Segment{far - Real(1), far + Real(2)}, note);
    EXPECT_EQ(found, (std::vector<std::uint32_t>{77, 77, 77}));
    found.clear();
    tree.raycast(Ray{Vec3{Real(0)}, far}, [&](std::uint32_t user, const Ray &ray) {
        found.push_back(user);
        return ray.max_t;
    });
    EXPECT_EQ(std::count(found.begin(), found.end(), 77U), 1);
    const auto closest = tree.closest(
        far * Real(2), [](std::uint32_t user) { return user == 77 ? Real(2e5) : infinity; });
    ASSERT_TRUE(closest);
    EXPECT_EQ(closest->user, 77U);
}

TEST(Orthtree, UpdateSaysWhetherTheCellChanged) {
    Quadtree tree({Vec2{Real(-64)}, Vec2{Real(64)}}, 8, 1);
    const auto item = tree.insert({Vec2{Real(10)}, Vec2{Real(11)}}, 0);
    tree.insert({Vec2{Real(-30)}, Vec2{Real(-29)}}, 1);
    EXPECT_FALSE(tree.update(item, {Vec2{Real(12)}, Vec2{Real(13)}}));
    EXPECT_TRUE(tree.update(item, {Vec2{Real(-30)}, Vec2{Real(-29)}}));
    EXPECT_EQ(tree.bounds(item).min, Vec2{Real(-30)});
}

TEST(Orthtree, CellsForDrawing) {
    Quadtree tree({Vec2{Real(0)}, Vec2{Real(8)}}, 2, 1);
    tree.insert({Vec2{Real(1)}, Vec2{Real(1)}}, 0);
    tree.insert({Vec2{Real(7)}, Vec2{Real(7)}}, 1);
    std::vector<std::tuple<Real, Real, int, std::size_t>> cells;
    tree.cells([&](const Rectangle &box, int depth, std::size_t count) {
        cells.emplace_back(box.min.x, box.max.y, depth, count);
    });
    const std::vector<std::tuple<Real, Real, int, std::size_t>> expected{
        {Real(0), Real(8), 0, 2}, {Real(0), Real(4), 1, 1}, {Real(4), Real(4), 1, 0},
        {Real(0), Real(8), 1, 0}, {Real(4), Real(8), 1, 1},
    };
    EXPECT_EQ(cells, expected);
}

TEST(Orthtree, CopiesAnswerAlike) {
    Octree tree({Vec3{Real(-64)}, Vec3{Real(64)}}, 6, 4);
    Random random(0x0c8);
    for (std::uint32_t i = 0; i < 500; ++i)
        tree.insert(any_box<3>(random), i);
    const Octree copy = tree;
    copy.validate();
    const auto list = [](const Octree &from) {
        std::vector<std::uint32_t> found;
        from.query(Aabb{Vec3{Real(-20)}, Vec3{Real(20)}}, [&](std::uint32_t user) {
            found.push_back(user);
            return true;
        });
        return found;
    };
    EXPECT_EQ(list(copy), list(tree));
}

TEST(Orthtree, SaysWhatIsWrong) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Vec2 zero{Real(0)}, one{Real(1)};
    says([&] { Quadtree({zero, Vec2{Real(1), Real(0)}}, 4, 4); }, "[0, 0] on axis 1");
    says([&] { Quadtree({zero, Vec2{infinity}}, 4, 4); }, "inf");
    says([&] { Quadtree({zero, one}, 17, 4); }, "17");
    says([&] { Quadtree({zero, one}, -1, 4); }, "-1");
    says([&] { Quadtree({zero, one}, 4, 0); }, "got 0");
    Quadtree tree({zero, one}, 4, 4);
    const auto item = tree.insert({zero, one}, 0);
    const auto go_on = [](std::uint32_t) { return true; };
    says([&] { tree.insert({one, zero}, 0); }, "[1, 0]");
    says([&] { tree.update(item, {zero, Vec2{nan}}); }, "nan");
    says([&] { tree.query(Rectangle{zero, Vec2{nan}}, go_on); }, "nan");
    says([&] { tree.query(Circle{zero, Real(-3)}, go_on); }, "-3");
    says([&] { tree.query(Segment2{zero, Vec2{infinity}}, go_on); }, "inf");
    says(
        [&] {
            tree.raycast(Ray2{zero, zero}, [](auto, const auto &r) { return r.max_t; });
        },
        "(0, 0)");
    says([&] { tree.closest(Vec2{nan}, [](auto) { return Real(0); }); }, "nan");
    says([&] { tree.closest(one, [](auto) { return Real(-8); }); }, "-8");
    says([&] { tree.remove(5); }, "5");
    says([&] { tree.remove(-1); }, "-1");
    tree.remove(item);
    says([&] { tree.remove(item); }, "0");
    says([&] { (void)tree.user(item); }, "0");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
