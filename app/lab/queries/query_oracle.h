// Exact answers for small cases, in integer arithmetic.
//
// Coordinates are integers of at most 2^14 in magnitude, so every product below fits in 128 bits
// and nothing is rounded. Nothing here shares a formula with the engine.
#pragma once

#include <array>
#include <cstdint>

namespace plumb::oracle {

using Int = std::int64_t;

struct Point {
    Int x = 0, y = 0, z = 0;

    Int operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    friend Point operator-(const Point &a, const Point &b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend Point operator+(const Point &a, const Point &b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend bool operator==(const Point &, const Point &) = default;
};

struct Ball {
    Point center;
    Int radius = 0;
};
struct Block { // an axis-aligned box
    Point min, max;
};
using Corners = std::array<Point, 3>;

// All shapes are closed sets. A "line" is a ray from `origin`; `is_segment` ends it at origin +
// along.
struct Line {
    Point origin;
    Point along; // zero only for a degenerate segment: a point
    bool is_segment = false;
};

bool contains(const Ball &ball, const Point &p);
bool contains(const Line &segment, const Point &p); // a segment
bool contains(const Corners &triangle, const Point &p);
bool meets(const Line &line, const Ball &ball);
bool meets(const Line &line, const Block &block);
bool meets(const Line &line, const Corners &triangle);
bool meets(const Ball &ball, const Block &block);
bool meets(const Block &a, const Block &b);
bool meets(const Corners &triangle, const Block &block);
bool meets(const Corners &a, const Corners &b);

} // namespace plumb::oracle
