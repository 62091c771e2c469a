// Error control of one-step methods: sizes, norms, the first step, the next step.
//
//   |x| = sqrt(mean (x_k / s_k)²),   s_k = atol + rtol size_k
//
// of the mechanism of the scene (core/mechanisms.h) where that is largest: what else there is loosens no tolerance.
// size_k is, body by body, that of the vector k belongs to: |r| for a position, 1 for an orientation (whose variation
// is an angle, or of its size), |ṙ| and |ẋ| for velocities. Vectors rather than components: steps do not depend on how
// the global axes lie, and a component that passes through zero does not make the tolerance absolute.
//
// Next step (Hairer, Nørsett, Wanner, "Solving Ordinary Differential Equations I", sec. II.4, and IV.2 for the PI
// part):
//   h_new = h · safety · err^(−α) · err_before^β, within [shrink, grow] h; after a rejection no growth.
// Predictive (Gustafsson; sec. IV.8), for stiff motions: no more than the trend of the last two steps allows,
//   h_new ≤ h · safety · (h/h_before) (err_before/err²)^α
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "formulations/problem.h"

namespace poinsot {

// Sizes of a state's 2 nv components, position variations first.
void component_sizes(const Problem& problem, std::span<const double> q, std::span<const double> v,
                     std::span<double> sizes);

class ErrorNorm {
 public:
  explicit ErrorNorm(const Problem& problem);

  double operator()(std::span<const double> x, std::span<const double> scale);  // of 2 nv components

 private:
  struct Part {
    double sum = 0;
    std::size_t components = 0;
  };
  std::vector<int> mechanism_;  // of each body
  std::vector<Part> parts_;     // by mechanism
};

// Part of the tolerance that makes a difference to the next step.
inline constexpr double kOfAccount = 0.1;

struct StepRule {
  double safety;
  double alpha, beta;  // exponents of this error and of the one before
  double shrink, grow;
  bool predictive = false;
};

class StepController {
 public:
  explicit StepController(const StepRule& rule) : rule_(rule) {}

  // The step to try after one of length h with this error (1 is the tolerance): accepted() or rejected().
  double accepted(double h, double error);
  double rejected(double h, double error);
  // The step could not be evaluated at all.
  double failed(double h);

 private:
  StepRule rule_;
  double before_ = 1e-4, h_before_ = 0;
  bool after_rejection_ = false;
};

// First step, from |y|, |f| and |f(after an Euler step h0) − f|/h0, the second derivative; h0 by first_trial().
double first_trial(double y, double f, double end);
double first_step(double h0, double f, double second, int order, double end);

// Steps that do not get on, tried at times t of a run to `end`.
//
// So many in a row that are so much smaller than the longest one do not pass a jump of the forces, which takes a few
// dozen: they creep towards a singular position, where less and less of the accelerations is more than rounding, or to
// where the motion grows without bound. And from a start whose steps do not grow, so many that cover so little of the
// way would take days to the end: with an atol far below rounding a body at rest asks for its noise to be resolved.
// Where the errors are noise every other step is rejected, and a hundred times the way is still little. Beside a
// singular position every stage is looked for from states around it: of these fewer are tried.
class Creeping {
 public:
  explicit Creeping(double end) : slow_{1e-6 * end}, noisy_{1e-4 * end}, beside_{1e-6 * end} {}

  bool tries(double t, double h) {
    tiny_ = h < kTiny * longest_ ? tiny_ + 1 : 0;
    slow_.tries(t);
    noisy_.tries(t);
    return tiny_ > kMostTiny || slow_.tried > kMost || (noisy_.tried > kMost && noisy_.rejected() > noisy_.tried / 4);
  }
  // A step from t was rejected beside a singular position; whether that is once too often.
  bool fails_beside(double t) {
    beside_.tries(t);
    return beside_.tried > kMostBeside;
  }
  // Steps are kept short for another reason.
  void limited() {
    longest_ = 0;
    tiny_ = 0;
  }
  void completed(double h) {
    longest_ = std::max(longest_, h);
    ++noisy_.completed;
  }

 private:
  static constexpr int kMostTiny = 100, kMost = 10000, kMostBeside = 400;
  static constexpr double kTiny = 1e-6;

  // What was tried since the motion came to where this stretch of it begins.
  struct Stretch {
    double length, from = 0;
    int tried = 0, completed = 0;

    void tries(double t) {
      if (!(t < from + length)) *this = {length, t};
      ++tried;
    }
    int rejected() const { return tried - completed; }
  };

  Stretch slow_, noisy_, beside_;
  double longest_ = 0;
  int tiny_ = 0;
};

// Error control has come to an end at time t with steps of length h; `cause` is what the last attempt failed of;
// without a message, of Newton's method.
Status step_too_small(double t, double h, const Status& cause);
// Where a motion is to be given out at a singular position; of a row, where one is known.
Status singular_sample(double t, const std::string& row);

}  // namespace poinsot
