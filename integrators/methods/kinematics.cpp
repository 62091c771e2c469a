#include "integrators/methods/kinematics.h"

#include <fmt/format.h>

#include <cmath>

#include "integrators/jacobian_policy.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/fixed_steps.h"

namespace poinsot {
namespace {

// Numbers are those of the paper's equations.
class Kinematics final : public FixedSteps {
 public:
  explicit Kinematics(const Run& run)
      : FixedSteps(run),
        refresh_(jacobians().require(settings_.jacobian).refresh),
        system_(problem_, run.systems.add(), MatrixKind::kinematic, run.statistics, clock_),
        delta_(nc_),
        q_next_(problem_.nq()),
        dq_(nv_) {
    if (settings_.reactions || settings_.signals) {
      inverse_dynamics_ = std::make_unique<Consistent>(problem_, settings_.linear());
    } else {
      x_.z.setZero(nv_);  // no multipliers
    }
  }

  Status prepare() override { return system_.prepare(); }

  // The start as given is only where the iteration begins.
  Status begin() override {
    clock_.start();
    if (Status status = find(0); !status.ok()) return status;
    if (problem_.has_discrete_state()) {
      if (Status status = accept(problem_); !status.ok()) return status;
    }
    return give_out(problem_);
  }

  Status step(double t) override {
    if (refresh_ == Refresh::before_step) {  // the original study's codes predict nothing
      x_.q = q_n_;
    } else {
      dq_.noalias() = h_ * v_n_;
      problem_.retract(span(q_n_), span(dq_), span(x_.q));  // (11)
    }
    return find(t);
  }

  Problem& stand() override { return problem_; }  // it does after every step

  Status complete() override {
    if (!inverse_dynamics_) return {};
    clock_.lap(Phase::other);
    Status status = inverse_dynamics_->accelerations(x_.t, span(x_.z));
    clock_.skip();
    return status;
  }

 private:
  Status find(double t) {
    if (Status status = find_position(t); !status.ok()) return status;
    return find_rates(t);
  }

  Status find_position(double t) {
    double correction = 0;
    for (int k = 0; k < settings_.max_iterations; ++k) {
      problem_.set_position(t, span(x_.q));
      problem_.position_residual(span(delta_));
      // A kept matrix would carry the position past a bifurcation unseen: kinematics keeps none.
      if (refresh_ != Refresh::before_step || k == 0) {
        if (Status status = system_.refresh(t, {}, {}, {}, {}); !status.ok()) return status;
      }
      delta_ = -delta_;
      if (Status status = system_.solve(t, span(delta_)); !status.ok()) return status;  // (14d)
      problem_.retract(span(x_.q), span(delta_), span(q_next_));                        // (14a), (12)
      x_.q.swap(q_next_);
      ++run_.statistics.newton_iterations;
      correction = delta_.norm();
      if (!std::isfinite(correction)) {
        return {Failure::not_finite, t, fmt::format("at t = {:.9g} s the position's correction is not finite", t)};
      }
      if (correction < settings_.tolerance) return {};
    }
    Eigen::Index largest = 0;
    delta_.cwiseAbs().maxCoeff(&largest);
    return {
        Failure::not_converged, t,
        fmt::format("at t = {:.9g} s the position did not converge: after {} iterations the correction is {:.3g}, the "
                    "tolerance {:.3g}; {} moves most; the mechanism may be locked here or the driver ask for more "
                    "than it can reach; try a smaller step",
                    t, settings_.max_iterations, correction, settings_.tolerance,
                    problem_.describe_unknown(static_cast<int>(largest)))};
  }

  Status find_rates(double t) {
    problem_.set_position(t, span(x_.q));
    if (Status status = system_.refresh(t, {}, {}, {}, {}); !status.ok()) return status;
    problem_.nu(span(x_.v));
    if (Status status = system_.solve(t, span(x_.v)); !status.ok()) return status;  // (15b)
    problem_.set_velocity(span(x_.v));
    problem_.gamma(x_.a());
    return system_.solve(t, x_.a());  // (16)
  }

  const Refresh refresh_;
  StepSystem system_;
  std::unique_ptr<Consistent> inverse_dynamics_;
  Vector delta_, q_next_, dq_;
};

}  // namespace

std::unique_ptr<Integrator> make_kinematics() {
  return std::make_unique<FixedStepIntegrator<Kinematics>>();
}

}  // namespace poinsot
