// What somebody writes who links the installed engine: a ball falls for a second.
#include <engine/plumb.h>

#include <cmath>
#include <cstdio>
#include <type_traits>

int main() {
    plumb::SceneDesc scene;
    plumb::BodyDesc ball;
    ball.name = "ball";
    ball.colliders.emplace_back().shape = plumb::SphereDesc{0.5};
    ball.position = {0, 100, 0};
    scene.bodies.push_back(ball);
#if defined(PLUMB_DOUBLE)
    static_assert(std::is_same_v<plumb::Real, double>);
    scene.world.precision = plumb::Precision::f64;
#else
    static_assert(std::is_same_v<plumb::Real, float>);
#endif
    // A question asked in this precision: does a ray along -z meet the ball?
    const plumb::Sphere sphere{plumb::Vec3(0, 100, 0), plumb::Real(0.5)};
    const plumb::Ray ray{plumb::Vec3(0, 100, 5), plumb::Vec3(0, 0, -1)};
    const bool seen = plumb::raycast(sphere, ray).has_value();

    const auto simulation = plumb::Simulation::create(scene, {}, nullptr);
    for (int i = 0; i < 60; ++i)
        simulation->step();
    const double fallen = 100 - simulation->read().bodies[0].position.y;
    std::printf("fell %.6f m in %.6f s; the ray %s the ball\n", fallen, simulation->time(),
                seen ? "meets" : "misses");
    // g t^2 / 2 = 4.905 m; the default method's substep of 1/240 s may add g t dt / 2 = 0.0204 m.
    return seen && std::abs(fallen - 4.905) < 0.021 ? 0 : 1;
}
