#include "app/lab/queries/query_set.h"

#include "app/lab/queries/query_list.h"

namespace plumb {

std::string_view query_method_name(QueryMethod method) {
    switch (method) {
    case QueryMethod::book:
        return "book";
    case QueryMethod::plain:
        return "plain";
    case QueryMethod::ours:
        return "plumb";
    }
    return "";
}

std::vector<QueryCase> query_cases(std::uint64_t seed, std::size_t adversarial) {
    Random random(seed);
    std::vector<QueryCase> cases;
    for (const auto query :
         {point_in_sphere, point_on_segment, point_in_triangle, ray_sphere, ray_aligned_box,
          ray_box, ray_triangle, segment_aligned_box, segment_box, segment_triangle,
          sphere_aligned_box, aligned_box_box, box_box, triangle_aligned_box, triangle_triangle})
        cases.push_back(query(random, adversarial));
    return cases;
}

} // namespace plumb
