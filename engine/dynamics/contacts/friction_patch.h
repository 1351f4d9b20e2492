// The patch over which two bodies touch. Contact points lie on its outline, but under even pressure
// friction acts closer to its centre and slows a spin less.
#pragma once

#include "engine/core/precision.h"

namespace plumb::inline PLUMB_PRECISION {

struct Contact;
struct StepContext;

// By what factor friction's lever arms about the centre of pressure are shorter than those of the
// contact points: the mean distance of the patch from its centre over that of its corners. 1/2 for
// a line, 0.46 to 0.65 for faces of three corners and more, 2/3 for a disc. 1 for a single point,
// and for bodies that do not spin flat on each other, where friction does not slide.
Real patch_spread(const StepContext &context, const Contact &contact);

} // namespace plumb::inline PLUMB_PRECISION
