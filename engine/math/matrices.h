// Minors, cofactors, adjugates, and the inverse that says when there is none. Transpose, product
// and determinant are GLM's.
//
// As in GLM, m[j][i] is in column j and row i.
#pragma once

#include "engine/math/types.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// At [j][i] the determinant of what is left of m without column j and row i.
Mat2 minors(const Mat2 &m);
Mat3 minors(const Mat3 &m);
Mat4 minors(const Mat4 &m);

// The minors with the signs of a chessboard, + at [0][0].
Mat2 cofactors(const Mat2 &m);
Mat3 cofactors(const Mat3 &m);
Mat4 cofactors(const Mat4 &m);

// The cofactors transposed: m * adjugate(m) == determinant(m) * identity.
Mat2 adjugate(const Mat2 &m);
Mat3 adjugate(const Mat3 &m);
Mat4 adjugate(const Mat4 &m);

// The inverse; none for a singular matrix, and for one whose determinant is not above 16 epsilon
// times its permanent (the same sum with all products positive): there roundings of the entries
// themselves could make it singular. The measure does not change when rows or columns are scaled,
// so small entries do not count as singular. A matrix that is not finite has none either.
//
// With p and d the permanent and determinant of m, an entry x is off by at most 8 epsilon times
// (the permanent of its minor + |x| p) / |d|.
std::optional<Mat2> try_inverse(const Mat2 &m);
std::optional<Mat3> try_inverse(const Mat3 &m);
std::optional<Mat4> try_inverse(const Mat4 &m);

} // namespace plumb::inline PLUMB_PRECISION
