#include "app/lab/queries/query_oracle.h"

#include <algorithm>
#include <optional>

namespace plumb::oracle {

namespace {

__extension__ using Wide = __int128;

Wide dot(const Point &a, const Point &b) {
    return Wide(a.x) * b.x + Wide(a.y) * b.y + Wide(a.z) * b.z;
}

// Sign of the volume spanned by three vectors.
int turn(const Point &a, const Point &b, const Point &c) {
    const Wide volume = a.x * (Wide(b.y) * c.z - Wide(b.z) * c.y) +
                        a.y * (Wide(b.z) * c.x - Wide(b.x) * c.z) +
                        a.z * (Wide(b.x) * c.y - Wide(b.y) * c.x);
    return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

Point cross(const Point &a, const Point &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A number t = top / bottom with bottom > 0.
struct Fraction {
    Wide top = 0, bottom = 1;

    friend bool operator<(const Fraction &a, const Fraction &b) {
        return a.top * b.bottom < b.top * a.bottom;
    }
};

Fraction fraction(Wide top, Wide bottom) {
    return bottom > 0 ? Fraction{top, bottom} : Fraction{-top, -bottom};
}

// Projects a plane to 2D by dropping the axis along which its normal is largest. Coplanar lines
// meet if their projections do.
struct Flat {
    int u = 0, v = 1;

    explicit Flat(const Point &normal) {
        const Int x = std::abs(normal.x), y = std::abs(normal.y), z = std::abs(normal.z);
        if (x >= y && x >= z) {
            u = 1;
            v = 2;
        } else if (y >= z) {
            u = 0;
            v = 2;
        }
    }
    [[nodiscard]] Wide cross(const Point &a, const Point &b) const {
        return Wide(a[u]) * b[v] - Wide(a[v]) * b[u];
    }
};

bool between(Int a, Int low, Int high) {
    return std::min(low, high) <= a && a <= std::max(low, high);
}

// A coplanar line and segment.
bool meet_in_plane(const Line &line, const Point &a, const Point &b, const Flat &flat) {
    const Point edge = b - a;
    const Point to_a = a - line.origin;
    const Wide denominator = flat.cross(line.along, edge);
    if (denominator != 0) {
        const Fraction t = fraction(flat.cross(to_a, edge), denominator);
        const Fraction s = fraction(flat.cross(to_a, line.along), denominator);
        return t.top >= 0 && (!line.is_segment || t.top <= t.bottom) && s.top >= 0 &&
               s.top <= s.bottom;
    }
    // Parallel, or one of them is a point: they meet if an end of one lies on the other.
    const auto on_line = [&](const Point &p) {
        const Point d = p - line.origin;
        const Point c = cross(d, line.along);
        if (c != Point{} || (line.along == Point{} && d != Point{}))
            return false;
        const Wide along = dot(d, line.along);
        return along >= 0 && (!line.is_segment || along <= dot(line.along, line.along));
    };
    return on_line(a) || on_line(b) || contains(Line{a, edge, true}, line.origin) ||
           (line.is_segment && contains(Line{a, edge, true}, line.origin + line.along));
}

} // namespace

bool contains(const Ball &ball, const Point &p) {
    const Point d = p - ball.center;
    return dot(d, d) <= Wide(ball.radius) * ball.radius;
}

bool contains(const Line &segment, const Point &p) {
    const Point d = p - segment.origin;
    if (cross(d, segment.along) != Point{})
        return false;
    const Point end = segment.origin + segment.along;
    return between(p.x, segment.origin.x, end.x) && between(p.y, segment.origin.y, end.y) &&
           between(p.z, segment.origin.z, end.z);
}

bool contains(const Corners &triangle, const Point &p) {
    return meets(Line{p, {}, true}, triangle);
}

bool meets(const Line &line, const Ball &ball) {
    const Point m = line.origin - ball.center;
    const Wide c = dot(m, m) - Wide(ball.radius) * ball.radius;
    if (c <= 0)
        return true;
    if (line.is_segment && contains(ball, line.origin + line.along))
        return true;
    // The line's closest point to the centre is at t = b / a.
    const Wide a = dot(line.along, line.along);
    const Wide b = -dot(m, line.along);
    if (b < 0 || a == 0 || (line.is_segment && b > a))
        return false;
    return b * b >= a * c;
}

bool meets(const Line &line, const Block &block) {
    Fraction enter{0, 1};
    std::optional<Fraction> exit;
    if (line.is_segment)
        exit = Fraction{1, 1};
    for (int i = 0; i < 3; ++i) {
        const Int o = line.origin[i];
        const Int d = line.along[i];
        if (d == 0) {
            if (o < block.min[i] || o > block.max[i])
                return false;
            continue;
        }
        Fraction near = fraction(block.min[i] - o, d);
        Fraction far = fraction(block.max[i] - o, d);
        if (far < near)
            std::swap(near, far);
        if (enter < near)
            enter = near;
        if (!exit || far < *exit)
            exit = far;
    }
    return !exit || !(*exit < enter);
}

bool meets(const Line &line, const Corners &triangle) {
    const auto &[a, b, c] = triangle;
    const Point normal = cross(b - a, c - a);
    if (normal == Point{}) { // degenerate: the same set as its three edges
        for (std::size_t i = 0; i < 3; ++i) {
            const Point p = triangle[i];
            const Point q = triangle[(i + 1) % 3];
            const Point across = cross(q - p, line.along);
            if (turn(q - p, line.along, line.origin - p) != 0)
                continue;
            const Point other = across != Point{} ? across : cross(q - p, line.origin - p);
            if (meet_in_plane(line, p, q, Flat(other)))
                return true;
        }
        return false;
    }
    const Wide height = dot(normal, line.origin - a);
    const Wide slope = dot(normal, line.along);
    if (slope == 0) {
        if (height != 0)
            return false;
        const Flat flat(normal);
        const auto side = [&](const Point &p, const Point &q) {
            const Wide s = flat.cross(q - p, line.origin - p);
            return s > 0 ? 1 : s < 0 ? -1 : 0;
        };
        const int s0 = side(a, b), s1 = side(b, c), s2 = side(c, a);
        if ((s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0))
            return true;
        return meet_in_plane(line, a, b, flat) || meet_in_plane(line, b, c, flat) ||
               meet_in_plane(line, c, a, flat);
    }
    const Fraction t = fraction(-height, slope);
    if (t.top < 0 || (line.is_segment && t.top > t.bottom))
        return false;
    const Point d = line.along;
    const int s0 = turn(d, a - line.origin, b - line.origin);
    const int s1 = turn(d, b - line.origin, c - line.origin);
    const int s2 = turn(d, c - line.origin, a - line.origin);
    return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

bool meets(const Ball &ball, const Block &block) {
    Wide distance = 0;
    for (int i = 0; i < 3; ++i) {
        const Int c = ball.center[i];
        const Int away = std::max<Int>({block.min[i] - c, c - block.max[i], 0});
        distance += Wide(away) * away;
    }
    return distance <= Wide(ball.radius) * ball.radius;
}

bool meets(const Block &a, const Block &b) {
    for (int i = 0; i < 3; ++i)
        if (a.max[i] < b.min[i] || b.max[i] < a.min[i])
            return false;
    return true;
}

// A triangle and a box meet if an edge of one meets the other.
bool meets(const Corners &triangle, const Block &block) {
    for (std::size_t i = 0; i < 3; ++i)
        if (meets(Line{triangle[i], triangle[(i + 1) % 3] - triangle[i], true}, block))
            return true;
    const auto corner = [&](int k) {
        return Point{(k & 1) != 0 ? block.max.x : block.min.x,
                     (k & 2) != 0 ? block.max.y : block.min.y,
                     (k & 4) != 0 ? block.max.z : block.min.z};
    };
    for (int k = 0; k < 8; ++k)
        for (int bit = 1; bit < 8; bit *= 2)
            if ((k & bit) == 0 &&
                meets(Line{corner(k), corner(k | bit) - corner(k), true}, triangle))
                return true;
    return false;
}

bool meets(const Corners &a, const Corners &b) {
    for (std::size_t i = 0; i < 3; ++i)
        if (meets(Line{a[i], a[(i + 1) % 3] - a[i], true}, b) ||
            meets(Line{b[i], b[(i + 1) % 3] - b[i], true}, a))
            return true;
    return false;
}

} // namespace plumb::oracle
