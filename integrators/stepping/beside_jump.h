// The motion at a state and beside it, in the one direction in which the force of a spring's law moves it: what the law
// depends on there, and how it changes.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "integrators/state.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/law_path.h"

namespace poinsot {

class BesideJump {
 public:
  // Of a state and a law that have to live as long.
  BesideJump(const Problem& problem, const LinearChoice& choice, const State& state, const SpringLaw& law);

  // Whether the force moves anything.
  bool moves() const { return direction_.size() > 0; }
  // The law's arguments at the state.
  const Arguments<double>& here() const { return here_; }
  // How fast the law's v changes where v is by so much another, or x.
  double change_beside_v(double by);
  double change_beside_x(double by);

 private:
  Arguments<double> arguments(const Eigen::VectorXd& v);
  double change(const Eigen::VectorXd& v);
  Eigen::VectorXd direction();
  LawPlace place() const { return law_.place(own_->model(), *own_, bodies_); }

  std::unique_ptr<Problem> own_;
  Consistent consistent_;
  const State& state_;
  const SpringLaw& law_;
  Eigen::VectorXd z_;
  std::vector<BodyState> bodies_;
  Arguments<double> here_;
  Eigen::VectorXd direction_;  // by which v changes by 1, and x; empty where nothing does
};

}  // namespace poinsot
