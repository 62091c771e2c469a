#include "integrators/methods/generalized_alpha.h"

#include "integrators/stepping/accept.h"
#include "integrators/stepping/consistent.h"
#include "integrators/stepping/newton_loop.h"
#include "integrators/stepping/observe.h"
#include "integrators/stepping/time_grid.h"
#include "integrators/stepping/velocity_rows.h"

namespace poinsot {
namespace {

using Vector = Eigen::VectorXd;

enum class Form { index3, stabilized2 };

struct Coefficients {
  double alpha_m, alpha_f, gamma, beta;

  explicit Coefficients(double rho)
      : alpha_m((2 * rho - 1) / (rho + 1)),
        alpha_f(rho / (rho + 1)),
        gamma(0.5 + alpha_f - alpha_m),
        beta(0.25 * (gamma + 0.5) * (gamma + 0.5)) {}
  double shift() const { return alpha_m - alpha_f; }             // a belongs to t + shift h
  double gain() const { return (1 - alpha_f) / (1 - alpha_m); }  // ∂a_{n+1}/∂v̇_{n+1}
};

class Run {
 public:
  Run(Form form, Problem& problem, LinearSolver& solver, const Settings& settings, State& state,
      const Observer& observe, Statistics& statistics)
      : form_(form),
        problem_(problem),
        state_(state),
        observe_(observe),
        statistics_(statistics),
        grid_(settings),
        h_(grid_.step()),
        k_(settings.spectral_radius),
        scale_{1, h_ * k_.gamma * k_.gain(), h_ * h_ * k_.beta * k_.gain()},
        policy_(jacobians().require(settings.jacobian)),
        system_(problem, solver, policy_.matrix, statistics, clock_),
        newton_(problem, system_, settings, policy_.refresh, statistics),
        consistent_(problem, settings.linear_solver),
        velocity_rows_(velocity_rows(problem)),
        nv_(problem.nv()),
        nc_(problem.nc()),
        x_(state),
        a_(nv_),
        jerk_(nv_),
        q_n_(state.q),
        v_n_(state.v),
        z_n_(state.z),
        dq_(nv_),
        y_(Vector::Zero(nv_)),
        held_dq_(nv_),
        held_v_(nv_),
        held_a_(nv_),
        residual_(nv_ + nc_),
        aside_(nv_ + nc_),
        there_(nv_ + nc_) {}

  Status operator()() {
    if (Status status = system_.prepare(); !status.ok()) return status;
    stand(0);
    sample(observe_, problem_, x_, statistics_);
    clock_.start();
    Status status = start(0);
    for (std::int64_t n = 1; n <= grid_.steps && status.ok(); ++n) {
      const double t = grid_.time(n);
      status = step(t);
      if (!status.ok()) break;
      x_.t = t;
      ++statistics_.steps;
      bool rewritten = false;
      if (problem_.has_discrete_state() || grid_.sampled(n)) {
        stand(t);
        if (status = accept(problem_, x_, rewritten); !status.ok()) break;
        if (rewritten) velocity_rows_ = velocity_rows(problem_);
      }
      if (grid_.sampled(n)) {
        clock_.lap(Phase::other);
        sample(observe_, problem_, x_, statistics_);
        clock_.skip();
      }
      // other coordinates, other v̈: what the state carries along belongs to the old ones
      if (rewritten && n < grid_.steps) status = restart(t);
    }
    finish(clock_, statistics_);
    state_ = x_;
    return status;
  }

 private:
  void stand(double t) {
    problem_.set_position(t, span(x_.q));
    problem_.set_velocity(span(x_.v));
  }

  // v̇, λ, a and, in index 3, the part of v normal to the constraints, from a consistent (q, v) where the problem
  // stands.
  Status start(double t) {
    if (Status status = consistent_.accelerations(t, span(x_.z)); !status.ok()) return status;
    // The error of the difference quotient, of order h/100, is less than the h² neglected. Where a whole step shows
    // that the change of v̇ is not resolved (a stiff spring out of rest), or is of second order, the start does without
    // v̈.
    if (Status status = change_of_acceleration(t, h_ / 100, jerk_); !status.ok()) return status;
    jerk_ *= 100;
    if (!change_of_acceleration(t, h_, a_).ok() || !((a_ - jerk_).norm() < jerk_.norm())) jerk_.setZero();
    jerk_ /= h_;
    a_.noalias() = x_.z.head(nv_) + (k_.shift() * h_) * jerk_;
    z_n_ = x_.z;
    y_.setZero();
    if (form_ == Form::stabilized2) return {};

    // h v̂ v̇ = T(hv)⁻¹ v̇ − T(−hv)⁻¹ v̇
    Vector forth = h_ * x_.v, back = -forth, plus = x_.z.head(nv_), minus = plus;
    problem_.lower(span(forth), span(plus));
    problem_.lower(span(back), span(minus));
    held_v_ = x_.v + (h_ * h_ * (1.0 / 6 - k_.beta - 0.5 * k_.shift())) * jerk_ + (h_ / 12) * (plus - minus);
    problem_.set_position(t, span(x_.q));
    problem_.set_velocity(span(held_v_));
    aside_.setZero();
    problem_.velocity_residual(span(aside_, nv_, nc_));
    for (int row : velocity_rows_) aside_[nv_ + row] = 0;
    if (Status status = consistent_.factor(t); !status.ok()) return status;
    if (Status status = consistent_.solve(t, span(aside_)); !status.ok()) return status;
    x_.v += aside_.head(nv_);
    return {};
  }

  // v̇ at t + s on the parabola through the state minus v̇ at t. The problem stands there then.
  Status change_of_acceleration(double t, double s, Vector& change) {
    held_dq_.noalias() = s * x_.v + (0.5 * s * s) * x_.z.head(nv_);
    problem_.retract(span(x_.q), span(held_dq_), span(q_n_));
    held_v_.noalias() = x_.v + s * x_.z.head(nv_);
    problem_.set_position(t + s, span(q_n_));
    problem_.set_velocity(span(held_v_));
    Status status = consistent_.accelerations(t + s, span(there_));
    change = there_.head(nv_) - x_.z.head(nv_);
    return status;
  }

  Status restart(double t) {
    aside_.setZero();
    problem_.velocity_residual(span(aside_, nv_, nc_));
    aside_ = -aside_;
    if (Status status = consistent_.factor(t); !status.ok()) return status;
    if (Status status = consistent_.solve(t, span(aside_)); !status.ok()) return status;
    x_.v += aside_.head(nv_);
    problem_.set_velocity(span(x_.v));
    return start(t);
  }

  // From (q, v, a, z) at t − h to the same at t; a failure leaves q and v as they were.
  Status step(double t) {
    held_a_.noalias() = (k_.alpha_f * x_.z.head(nv_) - k_.alpha_m * a_) / (1 - k_.alpha_m);
    held_v_.noalias() = x_.v + (h_ * (1 - k_.gamma)) * a_ + (h_ * k_.gamma) * held_a_;
    held_dq_.noalias() = h_ * x_.v + (h_ * h_ * (0.5 - k_.beta)) * a_ + (h_ * h_ * k_.beta) * held_a_;
    q_n_.swap(x_.q);
    v_n_.swap(x_.v);
    z_n_ = 2 * x_.z - z_n_;  // Newton's method starts from the line through the last two
    z_n_.swap(x_.z);

    const auto residual = [&](Vector& r) {
      advance();
      stand(t);
      problem_.step_residual(scale_, x_.a(), x_.lambda(), span(r));
      if (form_ == Form::stabilized2) keep_residual(r);
    };
    const auto matrix = [&] { return system_.refresh(t, scale_, span(dq_), x_.a(), x_.lambda()); };
    const auto correct = [&](Vector& delta) -> Status {
      problem_.lower(span(dq_), span(delta, 0, nv_));
      x_.z += delta;
      return form_ == Form::stabilized2 ? correct_velocity(t, delta) : Status{};
    };
    Status status = newton_.solve(t, scale_.position, x_.q, residual, matrix, correct);
    if (!status.ok()) {
      x_.q.swap(q_n_);
      x_.v.swap(v_n_);
      return status;
    }
    advance();
    a_.noalias() = k_.gain() * x_.z.head(nv_) + held_a_;
    return status;
  }

  void advance() {  // v and q that belong to the acceleration in z
    x_.v.noalias() = held_v_ + scale_.velocity * x_.z.head(nv_);
    dq_.noalias() = held_dq_ + scale_.position * x_.z.head(nv_);
    if (form_ == Form::stabilized2) dq_ += y_;
    problem_.retract(span(q_n_), span(dq_), span(x_.q));
  }

  // (G v − ν)/velocity that will be left when the correction for Φ/position has been made
  void keep_residual(const Vector& r) {
    problem_.velocity_residual(span(residual_, nv_, nc_));
    residual_.tail(nc_) = residual_.tail(nc_) / scale_.velocity - r.tail(nc_);
    for (int row : velocity_rows_) residual_[nv_ + row] = 0;
  }
  // An acceleration normal to the constraints takes it out, and y the displacement that goes with it.
  Status correct_velocity(double t, Vector& delta) {
    aside_.head(nv_).setZero();
    aside_.tail(nc_) = -residual_.tail(nc_);
    if (Status status = system_.solve(t, span(aside_)); !status.ok()) return status;
    x_.z += aside_;
    y_ -= scale_.position * aside_.head(nv_);
    delta = delta.cwiseAbs() + aside_.cwiseAbs();
    return {};
  }

  Form form_;
  Problem& problem_;
  State& state_;
  const Observer& observe_;
  Statistics& statistics_;
  TimeGrid grid_;
  double h_;
  Coefficients k_;
  StepScale scale_;
  const JacobianEntry& policy_;
  PhaseClock clock_;
  StepSystem system_;
  NewtonLoop newton_;
  Consistent consistent_;
  std::vector<int> velocity_rows_;
  Eigen::Index nv_, nc_;
  State x_;                           // z = (v̇, λ)
  Vector a_, jerk_;                   // as far as they are carried from step to step
  Vector q_n_, v_n_, z_n_, dq_;       // where the step began, z one step before
  Vector y_;                          // displacement of stabilized index 2
  Vector held_dq_, held_v_, held_a_;  // what does not depend on the step's unknowns
  Vector residual_, aside_, there_;
};

template <Form form>
class GeneralizedAlpha final : public Integrator {
 public:
  Status run(Problem& problem, LinearSolver& solver, const Settings& settings, State& state, const Observer& observe,
             Statistics& statistics) override {
    return Run(form, problem, solver, settings, state, observe, statistics)();
  }
};

}  // namespace

std::unique_ptr<Integrator> make_generalized_alpha() {
  return std::make_unique<GeneralizedAlpha<Form::index3>>();
}
std::unique_ptr<Integrator> make_generalized_alpha_i2() {
  return std::make_unique<GeneralizedAlpha<Form::stabilized2>>();
}

}  // namespace poinsot
