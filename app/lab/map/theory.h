// Limits that theory knows of, for the scenes where one applies.
#pragma once

#include "app/lab/map/map_layout.h"

#include <string_view>

namespace plumb {

// A body that is struck towards a wall.
struct StruckBody {
    double speed_ratio = 0; // of the struck body to the striker before, who hits it without rebound
    double way = 0;         // m, until the struck body's centre is in the middle of the wall
};

// Of a striker that flies along one of the world's axes (0 to 2) at one body at rest, straight in
// line with it, with one static body behind that. Nothing for scenes that are not so, or in which
// striker and struck rebound.
[[nodiscard]] std::optional<StruckBody> struck_before_wall(const SceneDesc &scene,
                                                           const std::string &striker, int axis);

// m: half of the wall's thickness and half of the size, along one of the world's axes (0 to 2), of
// what is thrown at it: a body of that name or its copies, all as large, without rebound, straight
// at the only static body. Nothing for scenes that are not so.
[[nodiscard]] std::optional<double> way_into_wall(const SceneDesc &scene, const std::string &thrown,
                                                  int axis);

// Of the only spring of a scene, between the world and what nothing else holds: a particle's
// angular frequency (rad/s) and mass (kg), both 0 of anything else.
struct Oscillator {
    double omega = 0, mass = 0;
};
[[nodiscard]] std::optional<Oscillator> lone_oscillator(const SceneDesc &scene,
                                                        const std::string &spring);

// The longest stable step (s) of x'' = -omega^2 x - rate x', where theory has one in closed form:
// of explicit Euler everywhere, none above 0 without damping (rate = 0); of semi-implicit Euler
// everywhere; of velocity Verlet everywhere, from its first substep of a step: 2 / omega undamped,
// a little more with some damping, 3.087 / rate with much; of Störmer-Verlet, which takes its
// kick's velocity from half a step of it, and RK4 where it is overdamped, rate >= 2 omega (rad/s).
// From |eigenvalues of the step's matrix| <= 1 (Jury's conditions); with lambda the faster of the
// two decays explicit Euler has 2 / lambda and RK4 2.785 / lambda (Hairer, Wanner 1996, sec. IV.2).
[[nodiscard]] std::optional<double> longest_damped_step(std::string_view method, double omega,
                                                        double rate);

// m: the side of the cubes, copies of a body of that name, that stand on a plane in one column, and
// are all that moves. Nothing for scenes that are not so.
[[nodiscard]] std::optional<double> column_of_cubes(const SceneDesc &scene,
                                                    const std::string &cube);

// How high a column of cubes of that side (m) a method's soft contacts hold up: above it the column
// buckles under its own weight. By Greenhill 1881 a clamped column of stiffness B under the weight
// q of a length does at q L^3 = 7.837 B. A soft contact between cubes of mass m is as stiff as k =
// m w^2 by soft_step, which warm starts in two halves, and half as stiff by tgs_soft, with w = 2 pi
// contact_frequency_ratio / h and h the substep; a quarter of it at each corner of a face resists a
// turn by k s^2 / 4. With q = m g / s, L = N s and B = s k s^2 / 4 that is N^3 = 7.837 k s / (4 m
// g). The lowest contact, stiffer on what does not move, counts as clamped.
//
// Nothing for other methods, for islands that take more substeps as they need them, and where
// contacts sleep or are kept (kept_travel): these hold more, 22 cubes of 1 m where 19 should.
[[nodiscard]] std::optional<double> highest_column(const ResolvedRun &run, double side);

// Of the only spring of a scene, undamped, between the world and what nothing else holds: a map's
// axis "spring.NAME.frequency", over dt or substeps.
[[nodiscard]] bool swings_by_itself(const SceneDesc &scene, const std::string &spring);

// The limits that can be read from a scene so far.
//
// Over dt and the speed of such a striker: where the struck body's way in a step ends in the middle
// of the wall. A method that makes its contacts at the start of a step, for bodies that move as
// they do then, sees what approaches a wall, but not what is struck towards it during the step;
// beyond the middle it pushes that out behind. With a gap of half the wall's thickness and half the
// body's size this is v dt = thickness + size. The striker, who follows, may press the body through
// from less if the solver does not converge. Naive impulses, which have contacts of what overlaps
// alone, have no curve there: the striker reaches into the body, and they lose it at some fifth.
//
// Over dt and the speed of what is thrown at a wall, of naive impulses: v dt = (thickness + size) /
// 2. What overlaps the wall when a step begins is stopped and pushed out by the side that is
// nearer: up to there each start is seen in time, above it some pass.
//
// Over dt and the frequency of such a spring, of the explicit methods that are stable up to some
// omega h, h the substep: 2 of the symplectic ones, 2 sqrt(2) of RK4 (Hairer, Lubich, Wanner 2006,
// sec. I.5.2 and Hairer, Wanner 1996, sec. IV.2). Explicit Euler, stable at none, has a curve
// without points. Over dt and the damping of such a spring: longest_damped_step.
//
// Over dt and the number of cubes in a column: highest_column.
[[nodiscard]] std::vector<TheoryCurve> theory_of(const StabilityMap &map,
                                                 const RunOptions &base = {});

} // namespace plumb
