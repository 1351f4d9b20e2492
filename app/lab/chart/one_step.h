// How wrong single steps are, from states of one accurate run: what can be said of motion that is
// chaotic, where two runs part however true both are.
#pragma once

#include "engine/scene/simulation.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace plumb {

// How far from the accurate run's next state (m), over all bodies and particles that are moved by
// forces, and over all instants. Of a body it is sqrt(x^2 + (r a)^2): x of its centre of mass, a
// the angle by which it is turned, r its radius of gyration, sqrt(trace(I) / (2 m)).
struct OneStepError {
    double rms = 0, worst = 0;
    std::string failure; // why there is none; empty when there is
};

struct OneStepOptions {
    RunOptions base;     // of the accurate run, where that is not its own matter
    double duration = 5; // s, of the accurate run
    // Asked often; true ends early. May be empty.
    std::function<bool()> stop;
    std::function<void(double)> progress; // fraction done; may be empty
};

class OneStepStates {
  public:
    using Make = std::function<std::shared_ptr<Simulation>(const SceneDesc &)>;

    // Runs the scene as accurate_run has it, with 64 steps of 4 substeps a frame. A frame is the
    // scene's dt, or as many of them as make 1/60 s. Throws std::invalid_argument when nothing in
    // the scene moves, when it ends before its first frame, or when that run fails.
    OneStepStates(const SceneDesc &scene, const OneStepOptions &options);

    // Of one frame from each state. What a solver remembers of the step before (loads, stiffnesses)
    // is its own: it goes along with the accurate run, and takes poses and velocities of that at
    // every frame. Those with which it begins to remember, up to 16, are not counted.
    //
    // `make` makes a simulation of that scene, or puts one that it made before there; with a dt
    // that does not divide the frame there is no error.
    [[nodiscard]] OneStepError error_of(const Make &make) const;

    [[nodiscard]] double frame() const { return frame_; } // s
    // The states: of every frame, or where there are very many, of ten stretches.
    [[nodiscard]] std::size_t instants() const;
    [[nodiscard]] const ResolvedRun &accurate() const { return accurate_; }
    // Of the accurate run itself: how far off it is by one with half its dt.
    [[nodiscard]] const OneStepError &own_error() const { return own_error_; }
    [[nodiscard]] bool interrupted() const { return interrupted_; }

  private:
    struct Stretch {
        std::size_t first = 0;     // of the accurate run's frames
        std::size_t steps = 0;     // one from each of its frames but the last
        std::size_t uncounted = 0; // of these
        std::vector<Frame> frames;
    };
    void lay_out_stretches(std::size_t frames);
    template <typename Add> // of each body and particle, the square of its distance (m^2)
    void add_squares(const Frame &frame, const Frame &truth, const Add &add) const;
    void follow(const SceneDesc &scene, const RunOptions &run, const OneStepOptions &options);
    [[nodiscard]] bool stopped() const { return stop_ && stop_(); }

    SceneDesc start_; // nothing remembered
    SoftParts soft_;
    std::vector<BodyInfo> bodies_;
    std::vector<glm::dvec3> mass_centres_; // of each body in its frame (m)
    std::vector<Stretch> stretches_;
    double frame_ = 0;
    ResolvedRun accurate_;
    OneStepError own_error_;
    std::function<bool()> stop_;
    bool interrupted_ = false;
};

} // namespace plumb
