#include "integrators/methods/implicit_euler.h"

#include "integrators/stepping/extrapolation.h"
#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/newton_loop.h"

namespace poinsot {
namespace {

class ImplicitEuler final : public FixedSteps {
 public:
  explicit ImplicitEuler(const Run& run)
      : FixedSteps(run),
        policy_(jacobians().require(settings_.jacobian)),
        system_(problem_, run.systems.add(policy_.workload()), policy_.matrix, run.statistics, clock_),
        newton_(problem_, system_, settings_, policy_.refresh, run.statistics),
        extrapolation_(x_.z),
        dq_(nv_) {
    resize(h_);
  }

  bool damps() const override { return true; }
  double index3_scale() const override { return scale_.position; }
  bool backward_velocities() const override { return true; }
  void resize(double before) override {
    scale_ = {1, h_, h_ * h_};
    extrapolation_.resize(x_.z, h_ / before);
    newton_.renew();
  }
  Status prepare() override { return system_.prepare(); }
  Status forget() override {
    extrapolation_.restart(x_.z);
    return {};
  }
  Status resume() override { return forget(); }
  Status leave_singular() override { return forget(); }

  // The unknowns are a = (r̈, ω̄̇) and λ at t_{n+1}, in x_.z. Numbers are those of the paper's equations for rA; rp has
  // (40) and (41) in the place of (32) and (34b), reps has (44).
  Status step(double t) override {
    if (policy_.refresh != Refresh::before_step)
      extrapolation_.lead(x_.z);  // the original study's codes predict nothing
    const auto advance = [&] {
      x_.v.noalias() = v_n_ + h_ * x_.z.head(nv_);  // (32a, b)  ṙ = ṙ_n + h r̈,  ω̄ = ω̄_n + h ω̄̇
      dq_.noalias() = h_ * x_.v;
      problem_.retract(span(q_n_), span(dq_), span(x_.q));  // (32c, d)  r = r_n + h ṙ,  A = A_n exp(h ω̃̄)
    };
    const auto residual = [&](Vector& g) {
      advance();
      stand_at(t);
      problem_.step_residual(scale_, x_.a(), x_.lambda(), span(g));  // (34b)  g = (M a + Gᵀλ − Q, Φ/h²)
    };
    const auto matrix = [&](Ahead ahead) -> Status {
      if (policy_.refresh == Refresh::before_step) return matrix_before_step(t, ahead);
      // (38b, c)  ∂g/∂(a, λ), made exact by T(hω̄)
      return system_.refresh(t, scale_, span(dq_), x_.a(), x_.lambda(), ahead);
    };
    const auto correct = [&](Vector& delta) -> Status {
      problem_.lower(span(dq_), span(delta, 0, nv_));  // T(hω̄)⁻¹, which (37) approximates by 1
      x_.z += delta;                                   // (35)  (a, λ) ← (a, λ) + δ
      return {};
    };
    Status status = newton_.solve(t, scale_.position, x_.z, x_.q, residual, matrix, correct);  // (38d) until (46)
    if (status.ok()) advance();
    return status;
  }

 private:
  void stand_at(double t) {
    problem_.set_position(t, span(x_.q));
    problem_.set_velocity(span(x_.v));
  }
  // The original study's: where the last step ended, with the rows of this one.
  Status matrix_before_step(double t, Ahead ahead) {
    problem_.set_position(t, span(q_n_));
    problem_.set_velocity(span(v_n_));
    return system_.refresh(t, scale_, {}, x_.a(), x_.lambda(), ahead);
  }

  const JacobianEntry& policy_;
  StepScale scale_;
  StepSystem system_;
  NewtonLoop newton_;
  Extrapolation extrapolation_;
  Vector dq_;  // the variation that leads from q_n to q
};

}  // namespace

std::unique_ptr<Integrator> make_implicit_euler() {
  return std::make_unique<FixedStepIntegrator<ImplicitEuler>>();
}

}  // namespace poinsot
