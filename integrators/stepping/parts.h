// Velocities of a problem by mechanism of the scene (core/mechanisms.h): what is looked for in one of them is seen
// whatever the others do.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/index.h"
#include "core/mechanisms.h"
#include "formulations/problem.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {

class Parts {
 public:
  explicit Parts(const Problem& problem)
      : mechanism_(mechanisms(problem.model())),
        per_body_(problem.bodies() > 0 ? problem.nv() / problem.bodies() : 0),
        runs_(mechanism_count(mechanism_)) {
    for (std::size_t b = 0; b < mechanism_.size(); ++b) {
      std::vector<Run>& runs = runs_[index(mechanism_[b])];
      const auto first = static_cast<Eigen::Index>(b) * per_body_;
      if (!runs.empty() && runs.back().first + runs.back().count == first)
        runs.back().count += per_body_;
      else
        runs.push_back({first, per_body_});
    }
  }

  std::size_t count() const { return runs_.size(); }
  Eigen::Index per_body() const { return per_body_; }  // components of a velocity
  std::size_t of_body(int body) const { return index(mechanism_[index(body)]); }
  // Row k of the problem, rp's normalizations behind the scene's.
  std::size_t of_row(const Problem& problem, std::size_t k) const {
    if (count() == 1) return 0;
    const std::vector<int>& scene = problem.model_rows();
    if (k >= scene.size()) return of_body(static_cast<int>(k - scene.size()));
    const Row& row = problem.model().rows[index(scene[k])];
    return of_body(row.i == kGround ? row.j : row.i);
  }
  // The maximum norm of numbers by row.
  double largest_row(std::size_t part, const Problem& problem, std::span<const double> x) const {
    if (count() == 1) return poinsot::largest(x);
    double most = 0;
    for (std::size_t k = 0; k < x.size(); ++k)
      if (of_row(problem, k) == part) most = std::max(most, std::abs(x[k]));
    return most;
  }

  // Calls visit(first, count) with the components of the part: of neighbouring bodies at one go.
  template <class Visit>
  void for_each_run(std::size_t part, Visit&& visit) const {
    for (const Run& run : runs_[part]) visit(run.first, run.count);
  }
  // The maximum norm; infinite where a component is not finite.
  double largest(std::size_t part, std::span<const double> x) const {
    double most = 0;
    for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
      most = std::max(most, poinsot::largest(x.subspan(index(first), index(count))));
    });
    return most;
  }
  // Whether what a mechanism has of something is rounding beside what all have: it rests while others move.
  bool rests(double part, double all) const {
    constexpr double kAtRest = 1e-9;
    return count() > 1 && !(part > kAtRest * all);
  }
  double dot(std::size_t part, const Eigen::VectorXd& x, const Eigen::VectorXd& y) const {
    double sum = 0;
    for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
      sum += x.segment(first, count).dot(y.segment(first, count));
    });
    return sum;
  }

  // rad/s, of a body, where the problem stands.
  double fastest_turn(std::size_t part, const Problem& problem) const {
    if (count() == 1) return problem.fastest_turn();
    double most = 0;
    for_each_run(part, [&](Eigen::Index first, Eigen::Index count) {
      for (Eigen::Index b = first; b < first + count; b += per_body_)
        most = std::max(most, problem.turn(static_cast<int>(b / per_body_)));
    });
    return most;
  }

 private:
  struct Run {
    Eigen::Index first, count;
  };
  std::vector<int> mechanism_;  // of each body
  Eigen::Index per_body_;
  std::vector<std::vector<Run>> runs_;  // by mechanism
};

}  // namespace poinsot
