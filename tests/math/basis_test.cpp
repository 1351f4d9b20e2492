#include "engine/math/basis.h"

#include "engine/core/random.h"
#include "tests/trials.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using Wide = glm::vec<3, long double>;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());
const Wide pole{-0.48L, -0.6L, -0.64L};

Wide wide(const Vec3 &v) {
    return {v.x, v.y, v.z};
}

Vec3 narrow(const Wide &v) {
    return {Real(v.x), Real(v.y), Real(v.z)};
}

Wide any_direction(Random &random) {
    for (;;) {
        const long double x = random.next_in(-1, 1), y = random.next_in(-1, 1);
        const long double z = random.next_in(-1, 1);
        const Wide v{x, y, z};
        const long double length = glm::length(v);
        if (length > 0.1L && length < 1.0L)
            return v / length;
    }
}

Wide any_perpendicular(Random &random, const Wide &n) {
    return glm::normalize(glm::cross(n, any_direction(random)));
}

// The largest error in unit length, orthogonality and handedness.
double orthonormal_error(const Wide &n, const TangentBasis &basis) {
    const Wide t1 = wide(basis.t1);
    const Wide t2 = wide(basis.t2);
    double worst = 0;
    for (const long double error :
         {glm::length(t1) - 1, glm::length(t2) - 1, glm::dot(t1, t2), glm::dot(t1, n),
          glm::dot(t2, n), glm::length(glm::cross(t1, t2) - n)})
        worst = std::max(worst, double(std::abs(error)));
    return worst;
}

// A reflection along w = n - pole: rounding n and the fixed frame to `Real` turns w by epsilon /
// |w|, and the basis by twice that. Add a dozen roundings for the arithmetic.
double tolerance(const Wide &n) {
    const double w = double(glm::length(n - pole));
    return 12 * epsilon + 4 * epsilon / w;
}

TEST(TangentBasis, OrthonormalAndRightHanded) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec3 n = narrow(any_direction(random));
        EXPECT_LE(orthonormal_error(wide(n), tangent_basis(n)), tolerance(wide(n)))
            << n.x << ' ' << n.y << ' ' << n.z;
    }
    for (int axis = 0; axis < 3; ++axis)
        for (const Real sign : {Real(-1), Real(1)}) {
            Vec3 n{Real(0)};
            n[axis] = sign;
            EXPECT_LE(orthonormal_error(wide(n), tangent_basis(n)), tolerance(wide(n)));
        }
}

// Down to the pole itself. The worst is where the errors of the reflection and the fallback are
// equal, epsilon / |w| = |w|.
TEST(TangentBasis, OrthonormalNearThePole) {
    Random random(2);
    const double worst = 4 * std::sqrt(epsilon);
    for (double angle = 1; angle > 1e-18; angle /= 3)
        for (int trial = 0; trial < 100; ++trial) {
            const Wide side = any_perpendicular(random, pole);
            const Wide exact = glm::normalize(pole + (long double)(angle)*side);
            const Vec3 n = narrow(exact);
            const double bound = std::min(tolerance(wide(n)), worst);
            EXPECT_LE(orthonormal_error(wide(n), tangent_basis(n)), bound) << angle;
        }
    const Vec3 n = narrow(pole);
    EXPECT_LE(orthonormal_error(wide(n), tangent_basis(n)), worst);
}

// Along great circles: H = 1 - 2 w w^T / w^2 turns by at most 2 |dn| / |w|.
TEST(TangentBasis, ContinuousAwayFromThePole) {
    Random random(3);
    const int steps = 2000;
    const long double step = 2 * 3.14159265358979323846L / steps;
    for (int circle = 0; circle < 100; ++circle) {
        const Wide u = any_direction(random);
        const Wide v = any_perpendicular(random, u);
        for (int i = 0; i < steps; ++i) {
            const Wide n0 = std::cos(i * step) * u + std::sin(i * step) * v;
            const Wide n1 = std::cos((i + 1) * step) * u + std::sin((i + 1) * step) * v;
            const double w = double(std::min(glm::length(n0 - pole), glm::length(n1 - pole)));
            if (w < 0.05)
                continue;
            const TangentBasis b0 = tangent_basis(narrow(n0));
            const TangentBasis b1 = tangent_basis(narrow(n1));
            const double allowed = 2 * double(step) / (w - double(step)) + 2 * tolerance(n0);
            EXPECT_LE(double(glm::distance(b0.t1, b1.t1)), allowed);
            EXPECT_LE(double(glm::distance(b0.t2, b1.t2)), allowed);
        }
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
