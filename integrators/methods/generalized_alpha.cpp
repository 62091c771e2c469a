#include "integrators/methods/generalized_alpha.h"

#include <fmt/format.h>

#include <utility>

#include "integrators/stepping/consistent.h"
#include "integrators/stepping/extrapolation.h"
#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/newton_loop.h"
#include "integrators/stepping/ringing.h"
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

class GeneralizedAlpha : public FixedSteps {
 public:
  GeneralizedAlpha(Form form, const Run& run)
      : FixedSteps(run),
        form_(form),
        k_(kSpectralRadius.of(settings_)),
        scale_(scale()),
        policy_(jacobians().require(settings_.jacobian)),
        system_(problem_, run.systems.add(policy_.workload()), policy_.matrix, run.statistics, clock_),
        newton_(problem_, system_, settings_, policy_.refresh, run.statistics, form == Form::index3),
        consistent_(problem_, settings_.linear()),
        velocity_rows_(velocity_rows(problem_)),
        a_(nv_),
        jerk_(nv_),
        extrapolation_(x_.z),
        dq_(nv_),
        corrects_velocity_(form == Form::stabilized2),
        y_(Vector::Zero(nv_)),
        eta_(Vector::Zero(nc_)),
        held_dq_(nv_),
        held_v_(nv_),
        held_a_(nv_),
        residual_(nv_ + nc_),
        aside_(nv_ + nc_),
        there_(nv_ + nc_) {}

  double index3_scale() const override { return scale_.position; }
  PhaseError phase_error() const override { return {-1.0 / 12 - 0.375 * k_.shift() * k_.shift(), -1.0 / 24}; }
  // Beside a singular position, where steps fail, stabilized index 2 has made velocities of noise in steps before:
  // those are done without its velocity constraints, as a whole.
  bool divides() const override { return form_ == Form::index3; }
  bool remembers() const override { return true; }
  // a belongs to t + shift h, and is v̇ there; where the line through the last two v̇ begins, to t − h.
  void resize(double before) override {
    scale_ = scale();
    const double ratio = h_ / before;
    a_ = x_.z.head(nv_) + ratio * (a_ - x_.z.head(nv_));
    extrapolation_.resize(x_.z, ratio);
    newton_.renew();
    eta_.setZero();
  }
  Status forget() override {
    extrapolation_.restart(x_.z);
    eta_.setZero();
    return {};
  }
  Status prepare() override { return system_.prepare(); }

  Status begin() override {
    if (Status status = FixedSteps::begin(); !status.ok()) return status;
    return run_.singular_for > 0 ? Status{} : start();
  }
  // The limit of v̇ stands in the state. That of v̈ is left out, and what it makes of v.
  Status leave_singular() override {
    velocity_rows_ = velocity_rows(problem_);
    a_ = x_.z.head(nv_);
    newton_.renew();
    return forget();
  }

  Status step(double t) override {
    held_a_.noalias() = (k_.alpha_f * x_.z.head(nv_) - k_.alpha_m * a_) / (1 - k_.alpha_m);
    held_v_.noalias() = v_n_ + (h_ * (1 - k_.gamma)) * a_ + (h_ * k_.gamma) * held_a_;
    held_dq_.noalias() = h_ * v_n_ + (h_ * h_ * (0.5 - k_.beta)) * a_ + (h_ * h_ * k_.beta) * held_a_;
    extrapolation_.lead(x_.z);
    if (Status status = lead_displacement(t); !status.ok()) return status;

    Status status = iterate(t);
    const bool open =
        status.failure == Failure::singular_matrix || (status.failure == Failure::not_converged && newton_.stalled());
    if (open && form_ == Form::stabilized2 && settings_.retry) status = iterate_at_index3(t);
    if (!status.ok()) return status;
    end_step();
    ringing_.watch(run_, x_.z, extrapolation_.before(), x_.q, t, h_,
                   [&](Vector& accelerations) { return keep_along(t, accelerations); });
    return status;
  }

  // With y a step may move the mechanism by more than its velocities do.
  Status check_turns(Problem& problem, double t) override {
    constexpr double kSmall = 0.05;  // squared: by less no body turns far in any coordinates
    if (Status status = FixedSteps::check_turns(problem, t); !status.ok()) return status;
    if (!(y_.squaredNorm() > kSmall)) return {};
    held_dq_ = dq_ / h_ - 0.5 * (v_n_ + x_.v);
    return check_moved(problem, held_dq_, t);
  }
  // Where the velocity constraints say nothing, what they make of the step is rounding.
  Status repeat_singular(double t) override {
    if (form_ == Form::index3) return {};
    if (Status status = iterate_at_index3(t); !status.ok()) return status;
    end_step();
    return {};
  }

  // In other coordinates v̈ is another, and what the state carries along belonged to the old ones.
  Status resume() override {
    velocity_rows_ = velocity_rows(problem_);
    aside_.setZero();
    problem_.velocity_residual(span(aside_, nv_, nc_));
    aside_ = -aside_;
    if (Status status = consistent_.factor(x_.t); !status.ok()) return status;
    if (Status status = consistent_.solve(x_.t, span(aside_)); !status.ok()) return status;
    x_.v += aside_.head(nv_);
    problem_.set_velocity(span(x_.v));
    return start();
  }

 private:
  // z of the step that the held parts begin, by Newton's method.
  Status iterate(double t) {
    const auto residual = [&](Vector& r) {
      advance();
      problem_.set_position(t, span(x_.q));
      problem_.set_velocity(span(x_.v));
      problem_.step_residual(scale_, x_.a(), x_.lambda(), span(r));
      if (corrects_velocity_) keep_residual(r);
    };
    const auto matrix = [&](Ahead ahead) {
      ahead.only = ahead.only && !corrects_velocity_;  // that is by the same matrix
      return system_.refresh(t, scale_, span(dq_), x_.a(), x_.lambda(), ahead);
    };
    const auto correct = [&](Vector& delta) -> Status {
      problem_.lower(span(dq_), span(delta, 0, nv_));
      x_.z += delta;
      return corrects_velocity_ ? correct_velocity(t, delta) : Status{};
    };
    return newton_.solve(t, scale_.position, x_.z, x_.q, residual, matrix, correct);
  }

  // Without velocity constraints, from where the step began.
  Status iterate_at_index3(double t) {
    corrects_velocity_ = false;
    x_.z = extrapolation_.before();
    y_.setZero();
    eta_.setZero();
    newton_.renew();
    const Status status = iterate(t);
    if (status.ok()) advance();
    corrects_velocity_ = true;
    if (status.ok()) tell_of_index3(t);
    return status;
  }

  // Of accelerations at the end of a step to t, what the constraints allow.
  Status keep_along(double t, Vector& accelerations) {
    problem_.set_position(t, span(x_.q));
    problem_.set_velocity(span(x_.v));
    if (Status status = consistent_.factor(t); !status.ok()) return status;
    return consistent_.along_constraints(x_, span(accelerations));
  }

  void end_step() {
    advance();
    a_.noalias() = k_.gain() * x_.z.head(nv_) + held_a_;
  }

  StepScale scale() const { return {1, h_ * k_.gamma * k_.gain(), h_ * h_ * k_.beta * k_.gain()}; }

  // v̇, λ, a and, in index 3, the part of v normal to the constraints, from a consistent (q, v) where the problem
  // stands.
  Status start() {
    if (Status status = consistent_.accelerations(x_.t, span(x_.z)); !status.ok()) return status;
    // The error of the difference quotient, of order h/100, is less than the h² neglected. Where a whole step shows
    // that the change of v̇ is not resolved (a stiff spring out of rest), or is of second order, the start does without
    // v̈.
    bool damped = false;
    if (Status status = leave_out_damped(damped); !status.ok()) return status;
    if (Status status = change_of_acceleration(h_ / 100, jerk_); !status.ok()) return status;
    jerk_ *= 100;
    if (damped || !change_of_acceleration(h_, a_).ok() || !((a_ - jerk_).norm() < jerk_.norm())) jerk_.setZero();
    jerk_ /= h_;
    a_.noalias() = x_.z.head(nv_) + (k_.shift() * h_) * jerk_;
    extrapolation_.restart(x_.z);
    eta_.setZero();
    if (form_ == Form::stabilized2) return {};

    // h v̂ v̇ = T(hv)⁻¹ v̇ − T(−hv)⁻¹ v̇
    Vector forth = h_ * x_.v, back = -forth, plus = x_.z.head(nv_), minus = plus;
    problem_.lower(span(forth), span(plus));
    problem_.lower(span(back), span(minus));
    held_v_ = x_.v + (h_ * h_ * (1.0 / 6 - k_.beta - 0.5 * k_.shift())) * jerk_ + (h_ / 12) * (plus - minus);
    problem_.set_position(x_.t, span(x_.q));
    problem_.set_velocity(span(held_v_));
    aside_.setZero();
    problem_.velocity_residual(span(aside_, nv_, nc_));
    for (int row : velocity_rows_) aside_[nv_ + row] = 0;
    if (Status status = consistent_.factor(x_.t); !status.ok()) return status;
    if (Status status = consistent_.solve(x_.t, span(aside_)); !status.ok()) return status;
    x_.v += aside_.head(nv_);
    return {};
  }

  // v̇ at a time s later on the parabola through the state minus v̇. The problem stands there then.
  Status change_of_acceleration(double s, Vector& change) {
    held_dq_.noalias() = s * x_.v + (0.5 * s * s) * x_.z.head(nv_);
    problem_.retract(span(x_.q), span(held_dq_), span(q_n_));
    held_v_.noalias() = x_.v + s * x_.z.head(nv_);
    problem_.set_position(x_.t + s, span(q_n_));
    problem_.set_velocity(span(held_v_));
    Status status = consistent_.accelerations(x_.t + s, span(there_));
    change = there_.head(nv_) - x_.z.head(nv_);
    return status;
  }

  // A damper far stiffer than 1/h has stopped what it acts on before the first step is over. With the acceleration it
  // begins with the method would ring for dozens of steps; without, the first step stops it. It is the direction in
  // which v̇ at a velocity v + h v̇ turns against v̇ by more than it was.
  Status leave_out_damped(bool& damped) {
    held_v_ = x_.v + h_ * x_.z.head(nv_);
    problem_.set_position(x_.t, span(x_.q));
    problem_.set_velocity(span(held_v_));
    if (Status status = consistent_.accelerations(x_.t, span(there_)); !status.ok()) return status;
    held_a_ = there_.head(nv_) - x_.z.head(nv_);
    const double along = held_a_.dot(x_.z.head(nv_)), square = held_a_.squaredNorm();
    damped = -along > x_.z.head(nv_).squaredNorm();
    if (damped) x_.z.head(nv_) -= (along / square) * held_a_;
    return {};
  }

  void tell_of_index3(double t) {
    if (std::exchange(told_, true)) return;
    run_.tell(
        fmt::format("at t = {:.6g} s stabilized index 2 did not converge, as beside a singular position, which leaves "
                    "velocities to rounding: such steps are those of index 3",
                    t));
  }

  void advance() {  // v and q that belong to the acceleration in z
    x_.v.noalias() = held_v_ + scale_.velocity * x_.z.head(nv_);
    dq_.noalias() = held_dq_ + scale_.position * x_.z.head(nv_);
    if (corrects_velocity_) dq_ += y_;
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
    eta_ -= residual_.tail(nc_);
    if (Status status = solve_normal(t, -residual_.tail(nc_)); !status.ok()) return status;
    x_.z += aside_;
    y_ -= scale_.position * aside_.head(nv_);
    delta = delta.cwiseAbs() + aside_.cwiseAbs();
    return {};
  }
  // Where y begins: the multiples of the step before in the directions of now. Carried along as it is, y would keep
  // what was normal there and is a motion here, from step to step. Where directions turn altogether, as beside a
  // singular position, nothing is known of it.
  Status lead_displacement(double t) {
    if (eta_.isZero(0)) {
      y_.setZero();
      return {};
    }
    if (Status status = solve_normal(t, eta_); !status.ok()) return status;
    aside_.head(nv_) *= -scale_.position;
    const bool goes_on = (aside_.head(nv_) - y_).squaredNorm() <= 0.25 * y_.squaredNorm();
    y_ = aside_.head(nv_);
    if (goes_on) return {};
    y_.setZero();
    eta_.setZero();
    return {};
  }
  template <class Along>
  Status solve_normal(double t, const Along& along) {
    aside_.head(nv_).setZero();
    aside_.tail(nc_) = along;
    return system_.solve(t, span(aside_));
  }

  Form form_;
  Coefficients k_;
  StepScale scale_;
  const JacobianEntry& policy_;
  StepSystem system_;
  NewtonLoop newton_;
  Consistent consistent_;
  std::vector<int> velocity_rows_;
  Vector a_, jerk_;
  Extrapolation extrapolation_;       // of z
  Vector dq_;                         // what leads from q_n to q
  bool corrects_velocity_;            // stabilized index 2, but for steps that do not converge so
  bool told_ = false;                 // of those
  Vector y_, eta_;                    // displacement of stabilized index 2, and what it is a multiple of by row
  Vector held_dq_, held_v_, held_a_;  // what does not depend on the step's unknowns
  Vector residual_, aside_, there_;
  Ringing ringing_{problem_};
};

struct Index3 final : GeneralizedAlpha {
  explicit Index3(const Run& run) : GeneralizedAlpha(Form::index3, run) {}
};
struct Stabilized2 final : GeneralizedAlpha {
  explicit Stabilized2(const Run& run) : GeneralizedAlpha(Form::stabilized2, run) {}
};

}  // namespace

std::unique_ptr<Integrator> make_generalized_alpha() {
  return std::make_unique<FixedStepIntegrator<Index3>>();
}
std::unique_ptr<Integrator> make_generalized_alpha_i2() {
  return std::make_unique<FixedStepIntegrator<Stabilized2>>();
}

}  // namespace poinsot
