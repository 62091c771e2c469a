#include "integrators/methods/half_implicit.h"

#include "integrators/stepping/broyden.h"
#include "integrators/stepping/extrapolation.h"
#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/newton_loop.h"
#include "integrators/stepping/step_ends.h"
#include "integrators/stepping/to_and_fro.h"
#include "integrators/stepping/velocity_rows.h"

namespace poinsot {
namespace {

class HalfImplicit final : public FixedSteps {
 public:
  explicit HalfImplicit(const Run& run)
      : FixedSteps(run),
        ends_(problem_, run.systems.add(), run.statistics, clock_),
        newton_(problem_, ends_.begin().system, settings_, Refresh::every_step, run.statistics),
        broyden_(problem_.nv() + problem_.nc(), problem_.nv()),
        velocity_rows_(velocity_rows(problem_)),
        extrapolation_(x_.z),
        dq_(nv_),
        rows_(nc_),
        to_and_fro_(run) {}

  double index3_scale() const override { return h_ * h_; }
  bool backward_velocities() const override { return true; }
  PhaseError phase_error() const override { return {1.0 / 24}; }
  Status prepare() override { return ends_.prepare(); }
  void resize(double before) override { extrapolation_.resize(x_.z, h_ / before); }
  Status forget() override {
    extrapolation_.restart(x_.z);
    return {};
  }
  Status resume() override {
    velocity_rows_ = velocity_rows(ends_.begin().problem);
    return forget();
  }
  Status leave_singular() override {
    place_beside(ends_.begin().problem);
    return resume();
  }
  Problem& stand() override { return ends_.begin().problem; }  // it does after every step
  Problem& last_seen() override { return stand(); }

  Status step(double t) override {
    extrapolation_.lead(x_.z);
    ends_.set_out();
    StepEnds::End &begin = ends_.begin(), &end = ends_.end();
    const auto advance = [&] {
      x_.v.noalias() = v_n_ + h_ * x_.z.head(nv_);
      dq_.noalias() = h_ * x_.v;
      problem_.retract(span(q_n_), span(dq_), span(x_.q));
      end.problem.set_position(t, span(x_.q));
    };
    const auto residual = [&](Vector& r) {
      advance();
      begin.problem.equations_of_motion(x_.a(), x_.lambda(), span(r, 0, nv_));
      end.problem.position_residual(span(r, nv_, nc_));
      r.tail(nc_) /= h_ * h_;
      if (velocity_rows_.empty()) return;
      end.problem.set_velocity(span(x_.v));
      end.problem.velocity_residual(span(rows_));
      for (int row : velocity_rows_) r[nv_ + row] = rows_[row] / h_;
    };
    const auto matrix = [&](Ahead ahead) { return begin.system.refresh(x_.t, {}, {}, x_.a(), x_.lambda(), ahead); };
    const auto correct = [&](Vector& delta) -> Status {
      broyden_.improve(delta);
      x_.z += delta;
      return {};
    };
    broyden_.restart();
    if (Status status = newton_.solve(t, h_ * h_, x_.z, x_.q, residual, matrix, correct); !status.ok()) return status;
    advance();
    end.problem.set_velocity(span(x_.v));
    ends_.take_turns();
    to_and_fro_.watch(run_, x_.v, v_n_, t, h_);
    return {};
  }

 private:
  StepEnds ends_;
  NewtonLoop newton_;
  Broyden broyden_;
  std::vector<int> velocity_rows_;
  Extrapolation extrapolation_;
  Vector dq_, rows_;
  ToAndFro to_and_fro_;
};

}  // namespace

std::unique_ptr<Integrator> make_half_implicit() {
  return std::make_unique<FixedStepIntegrator<HalfImplicit>>();
}

}  // namespace poinsot
