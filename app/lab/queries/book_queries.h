// The queries of the Game Physics Cookbook as it states them: baselines whose failures are known.
//
// After G. Szauer, "Game Physics Cookbook" (Packt 2017), chapters 7 to 11 and the code published
// with it; the formulas and the order of the operations are its own, the words are ours. Each
// comment names what goes wrong. Nothing but charts and tests may use them.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::book {

bool contains(const Sphere &sphere, const Vec3 &point);
bool contains(const Segment &segment, const Vec3 &point);
bool contains(const Triangle &triangle, const Vec3 &point);

// The direction is made a unit vector first, as the book's rays have one; max_t is not known there.
bool raycast(const Sphere &sphere, const Ray &ray);
bool raycast(const Aabb &box, const Ray &ray);
bool raycast(const Box &box, const Ray &ray);
bool raycast(const Triangle &triangle, const Ray &ray);

bool linetest(const Aabb &box, const Vec3 &a, const Vec3 &b);
bool linetest(const Box &box, const Vec3 &a, const Vec3 &b);
bool linetest(const Triangle &triangle, const Vec3 &a, const Vec3 &b);

bool overlaps(const Sphere &a, const Aabb &b);
bool overlaps(const Aabb &a, const Box &b);
bool overlaps(const Box &a, const Box &b);
bool overlaps(const Triangle &a, const Aabb &b);
bool overlaps(const Triangle &a, const Triangle &b);

// The published test of two oriented boxes reads the first box where it means the second, so it
// projects one box on both sides of the comparison.
bool overlaps_as_published(const Box &a, const Box &b);

} // namespace plumb::book
