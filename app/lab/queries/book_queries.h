// The Game Physics Cookbook's queries as published: baselines with known failures.
//
// After G. Szauer, "Game Physics Cookbook" (Packt 2017), chapters 7 to 11 and the code published
// with it; formulas and order of operations are the book's, the wording is ours. Each comment names
// what goes wrong. For charts and tests only.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::book {

bool contains(const Sphere &sphere, const Vec3 &point);
bool contains(const Segment &segment, const Vec3 &point);
bool contains(const Triangle &triangle, const Vec3 &point);

// The direction is normalized first, since the book's rays have unit directions; it has no max_t.
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

// The published OBB-OBB test reads the first box where it means the second, so it compares one
// box's projection with itself.
bool overlaps_as_published(const Box &a, const Box &b);

} // namespace plumb::book
