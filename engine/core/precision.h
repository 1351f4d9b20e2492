// The one place where the engine's precision is chosen.
//
// Everything that computes motion is written in `Real` and compiled twice, into the inline
// namespaces plumb::f32 and plumb::f64, so one program can hold both. Define PLUMB_DOUBLE for f64.
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
