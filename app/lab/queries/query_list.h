// The charted queries. Each draws its inputs from `random`, and `adversarial` inputs to judge.
#pragma once

#include "app/lab/queries/query_set.h"
#include "engine/core/random.h"

#include <cstddef>

namespace plumb {

QueryCase point_in_sphere(Random &random, std::size_t adversarial);
QueryCase point_on_segment(Random &random, std::size_t adversarial);
QueryCase point_in_triangle(Random &random, std::size_t adversarial);
QueryCase ray_sphere(Random &random, std::size_t adversarial);
QueryCase ray_aligned_box(Random &random, std::size_t adversarial);
QueryCase ray_box(Random &random, std::size_t adversarial);
QueryCase ray_triangle(Random &random, std::size_t adversarial);
QueryCase segment_aligned_box(Random &random, std::size_t adversarial);
QueryCase segment_box(Random &random, std::size_t adversarial);
QueryCase segment_triangle(Random &random, std::size_t adversarial);
QueryCase sphere_aligned_box(Random &random, std::size_t adversarial);
QueryCase aligned_box_box(Random &random, std::size_t adversarial);
QueryCase box_box(Random &random, std::size_t adversarial);
QueryCase triangle_aligned_box(Random &random, std::size_t adversarial);
QueryCase triangle_triangle(Random &random, std::size_t adversarial);

} // namespace plumb
