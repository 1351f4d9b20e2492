// Theoretical limits, for scenes where one applies.
#pragma once

#include "app/lab/map/map_layout.h"

#include <string_view>

namespace plumb {

// A body that is struck towards a wall.
struct StruckBody {
    double speed_ratio = 0; // struck body's speed over the striker's before impact, without rebound
    double way = 0; // m, the struck body's travel until its centre reaches the middle of the wall
};

// For a striker flying along a world axis (0 to 2) straight at a single body at rest, with a single
// static body behind it. nullopt for any other scene, or if the bodies rebound.
[[nodiscard]] std::optional<StruckBody> struck_before_wall(const SceneDesc &scene,
                                                           const std::string &striker, int axis);

// m: half the wall's thickness plus half the thrown body's size, along a world axis (0 to 2). The
// body of that name or its copies, all the same size, fly straight at the only static body, without
// rebound. nullopt for any other scene.
[[nodiscard]] std::optional<double> way_into_wall(const SceneDesc &scene, const std::string &thrown,
                                                  int axis);

// A scene's only spring, between the world and an otherwise free particle: its angular frequency
// (rad/s) and the particle's mass (kg); both 0 if the spring holds anything else.
struct Oscillator {
    double omega = 0, mass = 0;
};
[[nodiscard]] std::optional<Oscillator> lone_oscillator(const SceneDesc &scene,
                                                        const std::string &spring);

// The longest stable step (s) of x'' = -omega^2 x - rate x', where one is known: for explicit Euler
// always, though 0 without damping (rate = 0); for semi-implicit Euler always; for velocity Verlet
// always, from the first substep of a step: 2 / omega undamped, a little more with some damping,
// 3.087 / rate with much; for Störmer-Verlet, which takes its kick's velocity from half a step of
// it, and RK4 only when overdamped, rate >= 2 omega (rad/s). From |eigenvalues of the step matrix|
// <= 1 (Jury's conditions); with lambda the faster decay rate, explicit Euler has 2 / lambda and
// RK4 2.785 / lambda (Hairer, Wanner 1996, sec. IV.2).
[[nodiscard]] std::optional<double> longest_damped_step(std::string_view method, double omega,
                                                        double rate);

// Whether theory says that a run's energy grows without bound, however slowly: by explicit Euler,
// of a scene's only spring, which never tears, between the world and a particle, if the substep is
// above longest_damped_step (without damping: at any), or between the world and a body that nothing
// damps or locks, if the spring is undamped. False wherever nothing is known.
[[nodiscard]] bool grows_by_theory(const SceneDesc &scene, const ResolvedRun &run);

// m: the side of the cubes, copies of the body of that name, that stand on a plane in a single
// column and are all that moves. nullopt for any other scene.
[[nodiscard]] std::optional<double> column_of_cubes(const SceneDesc &scene,
                                                    const std::string &cube);

// The tallest column of cubes of that side (m) that a method's soft contacts hold up, in cubes: a
// taller one buckles under its own weight. By Greenhill 1881 a clamped column of bending stiffness
// B and weight q per length buckles at q L^3 = 7.837 B. A soft contact between cubes of mass m is
// as stiff as k = m w^2 by soft_step, which warm starts in two halves, and half as stiff by
// tgs_soft, with w = 2 pi contact_frequency_ratio / h and h the substep; a quarter of it at each
// corner of a face gives a rotational stiffness of k s^2 / 4. With q = m g / s, L = N s and B = s k
// s^2 / 4 that is N^3 = 7.837 k s / (4 m g). The lowest contact, stiffer because its support does
// not move, counts as clamped.
//
// nullopt for other methods, for islands that take more substeps as needed, and if contacts sleep
// or are kept (kept_travel): these hold more, 22 cubes of 1 m instead of 19.
[[nodiscard]] std::optional<double> highest_column(const ResolvedRun &run, double side);

// Whether this is the scene's only spring, undamped, between the world and an otherwise free mass:
// for a map axis "spring.NAME.frequency" or, if that mass is a particle, "spring.NAME.stiffness".
[[nodiscard]] bool swings_by_itself(const SceneDesc &scene, const std::string &spring);

// The theoretical limits that apply to a map's scene and axes.
//
// Over dt and the striker's speed (struck_before_wall): the struck body's travel in one step ends
// in the middle of the wall. A method that makes its contacts at the start of a step, from the
// velocities at that time, sees a body that approaches a wall, but not one that is struck towards
// it during the step; past the middle it pushes the body out on the far side. With a gap of half
// the wall's thickness plus half the body's size this is v dt = thickness + size. The striker,
// following behind, may press the body through at lower speeds if the solver does not converge.
// Naive impulses, which only make contacts for overlapping bodies, have no curve there: the striker
// reaches into the body, and they lose it at about a fifth.
//
// Over dt and the speed of a body thrown at a wall, for naive impulses: v dt = (thickness + size) /
// 2. A body that overlaps the wall when a step begins is stopped and pushed out on the nearer side:
// up to this limit every starting position is caught in time, above it some pass.
//
// Over dt and a lone spring's frequency or stiffness, for explicit methods stable up to some omega
// h, h the substep: 2 for the symplectic ones, 2 sqrt(2) for RK4 (Hairer, Lubich, Wanner 2006, sec.
// I.5.2 and Hairer, Wanner 1996, sec. IV.2). Explicit Euler is never stable: its curve has no
// points. Over dt and a lone spring's damping: longest_damped_step.
//
// Over dt and the number of cubes in a column: highest_column.
[[nodiscard]] std::vector<TheoryCurve> theory_of(const StabilityMap &map,
                                                 const RunOptions &base = {});

} // namespace plumb
