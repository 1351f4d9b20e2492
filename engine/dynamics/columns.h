// Structure of arrays: the same value of 16 rows side by side, so that the processor works on as
// many at once as it can.
#pragma once

#include "engine/math/types.h"

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace plumb::inline PLUMB_PRECISION {

inline constexpr std::size_t column_lanes = 16;

struct alignas(64) Column {
    Real lanes[column_lanes]; // NOLINT(modernize-avoid-c-arrays): what vectors load from
};
struct Columns3 {
    Column x, y, z;
};
inline void set(Columns3 &columns, std::size_t lane, const Vec3 &v) {
    columns.x.lanes[lane] = v.x;
    columns.y.lanes[lane] = v.y;
    columns.z.lanes[lane] = v.z;
}
inline Vec3 get(const Columns3 &columns, std::size_t lane) {
    return {columns.x.lanes[lane], columns.y.lanes[lane], columns.z.lanes[lane]};
}
// A symmetric matrix.
struct ColumnsSymmetric {
    Column xx, yy, zz, xy, xz, yz;
};
inline void set(ColumnsSymmetric &columns, std::size_t lane, const Mat3 &m) {
    columns.xx.lanes[lane] = m[0][0];
    columns.yy.lanes[lane] = m[1][1];
    columns.zz.lanes[lane] = m[2][2];
    columns.xy.lanes[lane] = m[1][0];
    columns.xz.lanes[lane] = m[2][0];
    columns.yz.lanes[lane] = m[2][1];
}
// Where each lane's body or particle starts, in Reals from the start of its array.
struct alignas(64) IndexColumn {
    using Index = std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t>;
    Index lanes[column_lanes]; // NOLINT(modernize-avoid-c-arrays)
};

} // namespace plumb::inline PLUMB_PRECISION
