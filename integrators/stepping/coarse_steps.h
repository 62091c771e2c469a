// Whether steps of a fixed length follow the vibrations and turns of bodies.
//
// Methods of second order make h ω of a vibration's phase in a step, less or more c (h ω)³ of it: c is 1/24 for the
// Störmer–Verlet scheme that RATTLE is of one spring, and half-implicit Euler, which only looks at it elsewhere; 1/12
// for the trapezoidal rule and the generalized-α methods about it (Hairer, Lubich, Wanner, Geometric Numerical
// Integration, VIII.3). Amplitudes and energy stay, so that nothing shows; yet after 1/c (h ω)³ steps the motion is
// elsewhere by all of its amplitude.
//
// h ω is measured: of a vibration Σ m |Δ²v|² over Σ m |Δv|², from one step to the next, is 4 sin²(½ Ω h), Ω being the
// numerical solution's, and that (h ω)² for the former and 4 tan²(½ Ω h) for the latter. What moves evenly or turns
// evenly has none: velocities are taken in space or in the body's frame, as they change less. The phase is added up
// over windows of looks, each as long as it vibrates and by its amplitude beside the largest speed there was. Where
// functions of time drive a mechanism its phase is theirs, in part at least, and long steps alone are told. Each
// mechanism (core/mechanisms.h) is by itself; of one that drivers leave no freedom nothing is looked at.
//
// Where orientations are no group's, in rp, an even turn has a phase to lose, too, c' (h |ω|)³ in a step.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/body_state.h"
#include "integrators/integrator.h"

namespace poinsot {

// What a method makes too much of in a step: of the phase of a vibration, and of an even turn in rp; 0: it says so
// itself, or makes none.
struct PhaseError {
  double vibration = 0;  // of (h ω)³
  double turn = 0;       // of (h |ω|)³
};

class CoarseSteps {
 public:
  CoarseSteps(const Run& run, const PhaseError& error);  // steps allocate nothing

  bool none() const { return none_; }
  // After each step, which ended at x; the problem stands there.
  void look(const Problem& problem, const State& x) {
    if (--until_ <= 0) add(problem, x);
  }
  // At the end of a run in steps of length h.
  void say(const Run& run, double h);

 private:
  static constexpr int kInRow = 3;  // states, of which differences are taken

  struct Motion {
    Vector3 rd, rd_body, w, w_body;
  };
  using Motions = std::array<Motion, kInRow>;
  struct Mechanism {
    bool watched = false, driven = false;
    double now = 0, kinetic = 0;                // J, at this look
    double first = 0, second = 0, squares = 0;  // J, J, J²: Σ m |Δv|², Σ m |Δ²v|² and of the first's squares
    double most_kinetic = 0;                    // J
    double noise = 0;                           // J, of which rounding can make as much
    double phase = 0;                           // rad³, Σ (h ω)³
    double vibrated = 0;                        // rad, that were gone through
    double fastest = 0;                         // rad/s, of a body at this look
    double turned = 0;                          // (rad/s)³, Σ |ω|³ of the fastest, by step
  };

  void add(const Problem& problem, const State& x);
  void take_differences(const Model& model);
  void end_window();
  void say_of_vibrations(const Run& run, double h, double scale);
  void say_of_turns(const Run& run, double h, double scale);

  const std::vector<int> mechanism_;  // of each body
  const PhaseError error_;
  std::vector<Mechanism> mechanisms_;
  std::vector<Motions> motions_;  // of each body
  std::vector<BodyState> bodies_;
  bool none_ = true;
  int apart_;      // steps from one look to the next, in the mean
  int until_ = 1;  // steps until the next state is taken
  int taken_ = 0;  // in a row
  std::int64_t looks_ = 0;
  int in_window_ = 0;  // looks
  int window_steps_ = 0;
  std::int64_t steps_ = 0;  // in windows that have ended
};

}  // namespace poinsot
