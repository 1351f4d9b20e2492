// Minors, cofactors, adjugates, and an inverse that reports when there is none. Transpose, product
// and determinant are GLM's.
//
// As in GLM, m[j][i] is column j, row i.
#pragma once

#include "engine/math/types.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// Entry [j][i] is the determinant of m without column j and row i.
Mat2 minors(const Mat2 &m);
Mat3 minors(const Mat3 &m);
Mat4 minors(const Mat4 &m);

// The minors with chessboard signs, + at [0][0].
Mat2 cofactors(const Mat2 &m);
Mat3 cofactors(const Mat3 &m);
Mat4 cofactors(const Mat4 &m);

// The cofactors transposed: m * adjugate(m) == determinant(m) * identity.
Mat2 adjugate(const Mat2 &m);
Mat3 adjugate(const Mat3 &m);
Mat4 adjugate(const Mat4 &m);

// The inverse; none for a singular or non-finite matrix, or if the determinant is at most 16
// epsilon times the permanent (the same sum with all products positive): rounding the entries alone
// could then make it singular. Scaling rows or columns does not change this test, so small entries
// do not count as singular.
//
// With p and d the permanent and determinant of m, an entry x is off by at most 8 epsilon times
// (the permanent of its minor + |x| p) / |d|.
std::optional<Mat2> try_inverse(const Mat2 &m);
std::optional<Mat3> try_inverse(const Mat3 &m);
std::optional<Mat4> try_inverse(const Mat4 &m);

} // namespace plumb::inline PLUMB_PRECISION
