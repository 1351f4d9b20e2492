// Answers probes in one precision; `answer` in probe.h picks the precision.
#pragma once

#include "engine/core/precision.h"
#include "engine/scene/probe.h"

namespace plumb::inline PLUMB_PRECISION {

// Throws CheckFailure where the geometry refuses.
ProbeAnswer answer_probe(const ProbeDesc &probe);

} // namespace plumb::inline PLUMB_PRECISION
