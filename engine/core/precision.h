// The one place where the engine's precision is chosen.
//
// Everything that computes motion is written in `Real` and compiled twice, into the inline
// namespaces plumb::f32 and plumb::f64, so that one program holds both. Define PLUMB_DOUBLE for the
// second.
#pragma once

#if defined(PLUMB_DOUBLE)
#define PLUMB_PRECISION f64
#else
#define PLUMB_PRECISION f32
#endif

namespace plumb::inline PLUMB_PRECISION {

#if defined(PLUMB_DOUBLE)
using Real = double;
#else
using Real = float;
#endif

} // namespace plumb::inline PLUMB_PRECISION
