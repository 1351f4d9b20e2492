// Prints vectors in check messages.
#pragma once

#include "engine/math/types.h"

#include <ostream>

namespace plumb::inline PLUMB_PRECISION {

// PLUMB_CHECK(..., "got " << Printed{v}) says (1, 2, 3).
template <typename Vector> struct Printed {
    const Vector &v;

    friend std::ostream &operator<<(std::ostream &out, const Printed &printed) {
        out << '(';
        for (int i = 0; i < Vector::length(); ++i)
            out << (i == 0 ? "" : ", ") << printed.v[i];
        return out << ')';
    }
};
template <typename Vector> Printed(const Vector &) -> Printed<Vector>;

} // namespace plumb::inline PLUMB_PRECISION
