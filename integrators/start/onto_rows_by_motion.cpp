#include <algorithm>
#include <utility>

#include "core/index.h"
#include "formulations/registry.h"
#include "integrators/settings.h"
#include "integrators/start/onto_rows.h"
#include "integrators/stepping/consistent.h"

namespace poinsot {
namespace {

class ByMotion : public OntoRows {
 public:
  ByMotion(const std::shared_ptr<const Model>& unit, RowSpace& space, std::vector<int> without,
           std::span<const double> sizes)
      : OntoRows(space, std::move(without), sizes),
        problem_(intrinsic_formulation().make(unit, without_)),
        consistent_(*problem_, LinearChoice{}),
        x_(index(problem_->nv() + problem_->nc())) {}

  bool position(double t, std::span<double> q) override {
    here_ = !put_;
    const bool done = (put_ ? consistent_.project_nearby(t, q) : consistent_.project_position(t, q)).ok();
    put_ = put_ || done;
    return done;
  }

  bool velocity(double t, std::span<const double> q, std::span<double> v) override {
    problem_->set_position(t, q);
    problem_->set_velocity(v);
    return (here_ ? consistent_.correct_velocity(t, v) : consistent_.project_velocity(t, v)).ok();
  }

  bool leave_free(double t, Eigen::MatrixXd& moves) override {
    for (Eigen::Index k = 0; k < moves.rows(); ++k) {
      std::ranges::fill(x_, 0.0);
      for (Eigen::Index j = 0; j < moves.cols(); ++j) x_[index(j)] = scaled(j) * scaled(j) * moves(k, j);
      if (!consistent_.solve(t, x_).ok()) return false;
      for (Eigen::Index j = 0; j < moves.cols(); ++j) moves(k, j) = x_[index(j)];
    }
    return true;
  }

 private:
  // The factors at hand belong to a position as far away as the last correction was large: not nothing in long scenes,
  // where rounding of coordinates alone moves their middle by micrometres.
  bool be_exact(double t) override { return here_ = consistent_.factor(t).ok(); }

  std::unique_ptr<Problem> problem_;
  Consistent consistent_;
  std::vector<double> x_;
  bool put_ = false;   // once
  bool here_ = false;  // the factors at hand are those of the last position
};

}  // namespace

std::unique_ptr<OntoRows> onto_rows_by_motion(const std::shared_ptr<const Model>& unit, RowSpace& space,
                                              std::vector<int> without, std::span<const double> sizes) {
  return std::make_unique<ByMotion>(unit, space, std::move(without), sizes);
}

}  // namespace poinsot
