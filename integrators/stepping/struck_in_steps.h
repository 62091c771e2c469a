// Steps of a fixed length in which a law changes its force by so much that the step, not the law, decides what a
// contact gives back of what it took: told once a law, with a step that resolves it.
//
// A force that changes by ΔF in a step of h, by where its ends go, changes the rate of its spring by h ΔF/m. Where that
// is kStruck of the largest rate so far, (h w)² of what the law is like at the contact, energy is made or lost by as
// much. Laws are looked at after steps that change a body's velocity by a part of it alone.
#pragma once

#include <vector>

#include "integrators/integrator.h"
#include "integrators/state.h"
#include "integrators/stepping/law_path.h"

namespace poinsot {

class StruckInSteps {
 public:
  // Of the expressions of the model, which has to live as long.
  StruckInSteps(const Model& model, Tell tell);

  bool none() const { return laws_.empty(); }
  // Whether a step from v_n to v is to be looked at.
  bool due(const Eigen::VectorXd& v, const Eigen::VectorXd& v_n);
  // The step of h from (q_n, v_n) to `at`, where the problem stands, before and after.
  void look(Problem& problem, const State& at, const Eigen::VectorXd& q_n, const Eigen::VectorXd& v_n, double h);

 private:
  static constexpr double kStruck = 0.25;

  struct Law {
    SpringLaw of;
    double fastest = 0;  // rate, of the ends of steps looked at
  };
  struct End {
    Arguments<double> at;
    double rate;
  };
  End end(const Law& law, const Problem& problem, double t) const;

  const Model& model_;
  const Tell tell_;
  std::vector<Law> laws_;
  std::vector<End> before_;
  std::vector<BodyState> bodies_;
};

}  // namespace poinsot
