// Surfaces that Plumb makes, in double precision.
#pragma once

#include "engine/scene/shape_desc.h"

namespace plumb {

// Closed but for the bowl; fronts outside.
MeshData make_mesh(const MeshModel &model);

// Hills cut into squares, as many along z as come nearest to the half extents.
HeightFieldDesc make_height_field(const HillsModel &hills);

// Of that height field, rows times columns; as a number that cannot overflow.
double sample_count(const HillsModel &hills);

} // namespace plumb
