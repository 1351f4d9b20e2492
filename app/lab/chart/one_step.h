// Error of single steps from states of one accurate run. Works for chaotic motion too, where two
// runs diverge however accurate they are.
#pragma once

#include "engine/scene/simulation.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace plumb {

// Distance from the accurate run's next state (m), over all bodies and particles moved by forces
// and all instants. For a body it is sqrt(x^2 + (r a)^2): x the distance of its centre of mass, a
// the rotation angle between the two, r its radius of gyration, sqrt(trace(I) / (2 m)).
struct OneStepError {
    double rms = 0, worst = 0;
    std::string failure; // why there is no error; empty if there is one
};

struct OneStepOptions {
    RunOptions base;     // options the accurate run does not set itself
    double duration = 5; // s, of the accurate run
    // Polled often; true ends early. May be empty.
    std::function<bool()> stop;
    std::function<void(double)> progress; // fraction done; may be empty
};

class OneStepStates {
  public:
    using Make = std::function<std::shared_ptr<Simulation>(const SceneDesc &)>;

    // Runs the scene with accurate_run's options, at 64 steps of 4 substeps per frame. A frame is
    // the dt of `options.base` or the scene, or enough of them to make up 1/60 s. Throws
    // std::invalid_argument if nothing in the scene moves, if it ends before its first frame, or if
    // that run fails.
    OneStepStates(const SceneDesc &scene, const OneStepOptions &options);

    // Error of one frame from each state. What a solver keeps from step to step (accumulated
    // impulses, stiffnesses) is its own: it follows the accurate run, taking that run's poses and
    // velocities at every frame. The first frames of a stretch, up to 16, only build up this memory
    // and are not counted.
    //
    // `make` makes a simulation of the given scene, or resets an earlier one to it. If its dt does
    // not divide the frame, the result is a failure.
    [[nodiscard]] OneStepError error_of(const Make &make) const;

    [[nodiscard]] double frame() const { return frame_; } // s
    // Number of states: those of every frame or, for long runs, of ten stretches.
    [[nodiscard]] std::size_t instants() const;
    [[nodiscard]] const ResolvedRun &accurate() const { return accurate_; }
    // Error of the accurate run itself, against a run at half its dt.
    [[nodiscard]] const OneStepError &own_error() const { return own_error_; }
    [[nodiscard]] bool interrupted() const { return interrupted_; }

  private:
    struct Stretch {
        std::size_t first = 0;     // index into the accurate run's frames
        std::size_t steps = 0;     // one from each frame but the last
        std::size_t uncounted = 0; // steps not counted, at the start
        std::vector<Frame> frames;
    };
    void lay_out_stretches(std::size_t frames);
    template <typename Add> // squared distance of each body and particle (m^2)
    void add_squares(const Frame &frame, const Frame &truth, const Add &add) const;
    void follow(const SceneDesc &scene, const RunOptions &run, const OneStepOptions &options);
    [[nodiscard]] bool stopped() const { return stop_ && stop_(); }

    SceneDesc start_; // without solver memory
    SoftParts soft_;
    std::vector<BodyInfo> bodies_;
    std::vector<glm::dvec3> mass_centres_; // in each body's frame (m)
    std::vector<Stretch> stretches_;
    double frame_ = 0;
    ResolvedRun accurate_;
    OneStepError own_error_;
    std::function<bool()> stop_;
    bool interrupted_ = false;
};

} // namespace plumb
