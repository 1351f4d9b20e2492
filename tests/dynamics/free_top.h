// Torque-free rotation in closed form, by Jacobi's elliptic functions, in long double.
#pragma once

#include "tests/dynamics/rigid_spin.h"

#include <array>
#include <glm/geometric.hpp>
#include <numbers>

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

struct Elliptic {
    long double sn = 0, cn = 1, dn = 1;
};

// Jacobi's elliptic functions of u with the parameter m = k^2, 0 <= m < 1, by the
// arithmetic-geometric mean (descending Landen; Abramowitz and Stegun, 16.4.1 to 16.4.4).
inline Elliptic jacobi(long double u, long double m) {
    constexpr int halvings = 8; // each doubles the digits
    std::array<long double, halvings + 1> a{1};
    std::array<long double, halvings + 1> c{std::sqrt(m)};
    long double b = std::sqrt(1 - m);
    for (std::size_t n = 1; n <= halvings; ++n) {
        a[n] = (a[n - 1] + b) / 2;
        c[n] = (a[n - 1] - b) / 2;
        b = std::sqrt(a[n - 1] * b);
    }
    long double phi = std::ldexp(a[halvings] * u, halvings);
    for (std::size_t n = halvings; n > 0; --n)
        phi = (phi + std::asin(c[n] / a[n] * std::sin(phi))) / 2;
    const long double sn = std::sin(phi);
    return {sn, std::cos(phi), std::sqrt(1 - m * sn * sn)};
}

// The quarter period K(m) (Abramowitz and Stegun, 17.6.3).
inline long double quarter_period(long double m) {
    long double a = 1;
    long double b = std::sqrt(1 - m);
    for (int n = 0; n < 8; ++n) {
        const long double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    return std::numbers::pi_v<long double> / (2 * a);
}

// A top with three different moments whose spin at time zero has no component about its middle axis
// and some about both others (Landau and Lifshitz 1976, "Mechanics", sec. 37, where the moments are
// sorted).
class FreeTop {
  public:
    FreeTop(const WideVec &moments, const WideVec &spin) : moments_(moments), start_(spin) {
        std::array<int, 3> order{0, 1, 2};
        std::ranges::sort(order, {}, [&](int i) { return moments[i]; });
        middle_ = order[1];
        momentum_ = glm::length(moments * spin);
        // If M^2 > 2 E I2, it turns about the axis of the greatest moment.
        const long double twice_energy = glm::dot(spin, moments * spin);
        const bool above = momentum_ * momentum_ > twice_energy * moments[middle_];
        turns_ = above ? order[2] : order[0];
        swings_ = above ? order[0] : order[2];
        const long double aside = moments[turns_] - moments[middle_];
        const long double across = moments[middle_] - moments[swings_];
        const long double of_swing = moments[swings_] * spin[swings_] * spin[swings_];
        const long double of_turn = moments[turns_] * spin[turns_] * spin[turns_];
        // Eqs. (37.8) to (37.10), with axes 1 and 3 exchanged if needed.
        rate_ = std::sqrt(aside * (aside + across) * of_turn / (moments.x * moments.y * moments.z));
        parameter_ = across * of_swing / (aside * of_turn);
        const long double size =
            std::sqrt(of_swing * (aside + across) / (moments[middle_] * aside));
        // From Euler's equation for the middle axis, when the axes are in the order x, y, z.
        is_even_ = (middle_ + 1) % 3 == turns_;
        const long double pull = (aside + across) * spin[turns_] * spin[swings_];
        middle_spin_ = std::copysign(size, is_even_ ? pull : -pull);
    }

    // Eq. (37.12), s.
    long double period() const { return 4 * quarter_period(parameter_) / rate_; }

    // Eq. (37.10), in body axes.
    WideVec spin_at(long double time) const {
        const Elliptic e = jacobi(rate_ * time, parameter_);
        WideVec spin{0};
        spin[swings_] = start_[swings_] * e.cn;
        spin[middle_] = middle_spin_ * e.sn;
        spin[turns_] = start_[turns_] * e.dn;
        return spin;
    }

    // The rotation in a world frame whose axis `turns` is along the angular momentum. The
    // precession about that axis starts from zero at `from`.
    WideQuat rotation_at(long double time, long double from) const {
        const WideVec momentum = moments_ * spin_at(time);
        const int first = is_even_ ? swings_ : middle_;
        const int second = is_even_ ? middle_ : swings_;
        // Eqs. (37.13) and (37.14).
        const long double theta =
            std::atan2(std::hypot(momentum[first], momentum[second]), momentum[turns_]);
        const long double psi = std::atan2(momentum[first], momentum[second]);
        return product(product(about(turns_, precession(from, time)), about(first, theta)),
                       about(turns_, psi));
    }

  private:
    static WideQuat about(int axis, long double angle) {
        WideVec part{0};
        part[axis] = std::sin(angle / 2);
        return {std::cos(angle / 2), part.x, part.y, part.z};
    }
    // Eq. (37.15), by Simpson's rule.
    long double precession(long double from, long double to) const {
        const auto rate = [&](long double time) {
            WideVec across = spin_at(time);
            across[turns_] = 0;
            const WideVec momentum = moments_ * across;
            return momentum_ * glm::dot(across, momentum) / glm::dot(momentum, momentum);
        };
        constexpr int intervals = 1000;
        const long double h = (to - from) / intervals;
        long double sum = rate(from) + rate(to);
        for (int i = 1; i < intervals; ++i)
            sum += (i % 2 == 1 ? 4 : 2) * rate(from + i * h);
        return sum * h / 3;
    }

    WideVec moments_;
    WideVec start_;
    int swings_ = 0; // the spin about this axis is a cn, about the middle one sn,
    int middle_ = 0;
    int turns_ = 0; // and about this one, which keeps its sign, dn
    bool is_even_ = true;
    long double momentum_ = 0;    // kg m^2/s
    long double rate_ = 0;        // 1/s
    long double parameter_ = 0;   // k^2
    long double middle_spin_ = 0; // its maximum, rad/s
};

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION
