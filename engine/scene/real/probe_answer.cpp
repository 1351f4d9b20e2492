#include "engine/scene/real/probe_answer.h"

#include "engine/scene/real/probe_asking.h"

#include <utility>

namespace plumb::inline PLUMB_PRECISION {

ProbeAnswer answer_probe(const ProbeDesc &probe) {
    Asking ask(probe);
    switch (probe.question) {
    case ProbeQuestion::vectors:
        answer_vectors(ask);
        break;
    case ProbeQuestion::basis:
        answer_basis(ask);
        break;
    case ProbeQuestion::transform:
        answer_transform(ask);
        break;
    case ProbeQuestion::matrix:
        answer_matrix(ask);
        break;
    case ProbeQuestion::contains:
        answer_contains(ask);
        break;
    case ProbeQuestion::closest:
        answer_closest(ask);
        break;
    case ProbeQuestion::overlap:
        answer_overlap(ask);
        break;
    case ProbeQuestion::classify:
        answer_classify(ask);
        break;
    case ProbeQuestion::planes:
        answer_planes(ask);
        break;
    case ProbeQuestion::raycast:
        answer_raycast(ask);
        break;
    case ProbeQuestion::distance:
        answer_distance(ask);
        break;
    case ProbeQuestion::penetration:
        answer_penetration(ask);
        break;
    case ProbeQuestion::collide:
        answer_collide(ask);
        break;
    case ProbeQuestion::cast:
        answer_cast(ask);
        break;
    case ProbeQuestion::enclose:
        answer_enclose(ask);
        break;
    case ProbeQuestion::tree:
        answer_tree(ask);
        break;
    case ProbeQuestion::models:
        answer_models(ask);
        break;
    case ProbeQuestion::frustum:
        answer_frustum(ask);
        break;
    case ProbeQuestion::cull:
        answer_cull(ask);
        break;
    case ProbeQuestion::pick:
        answer_pick(ask);
        break;
    }
    return std::move(ask.answer);
}

} // namespace plumb::inline PLUMB_PRECISION
