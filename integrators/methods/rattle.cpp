#include "integrators/methods/rattle.h"

#include "integrators/stepping/broyden.h"
#include "integrators/stepping/extrapolation.h"
#include "integrators/stepping/fixed_steps.h"
#include "integrators/stepping/newton_loop.h"
#include "integrators/stepping/step_ends.h"
#include "integrators/stepping/to_and_fro.h"
#include "integrators/stepping/velocity_rows.h"

namespace poinsot {
namespace {

class Rattle final : public FixedSteps {
 public:
  explicit Rattle(const Run& run)
      : FixedSteps(run),
        ends_(problem_, run.systems.add(), run.statistics, clock_),
        newton_(problem_, ends_.begin().system, settings_, Refresh::every_step, run.statistics),
        broyden_(problem_.nv() + problem_.nc(), problem_.nv()),
        velocity_rows_(velocity_rows(problem_)),
        z_(x_.z),
        extrapolation_(z_),
        u_(nv_),
        dq_(nv_),
        e_(nv_),
        momentum_(nv_),
        rows_(nc_),
        rhs_(nv_ + nc_),
        zeros_(Vector::Zero(nv_ + nc_)),
        to_and_fro_(run) {}

  PhaseError phase_error() const override { return {1.0 / 24, 1.0 / 6}; }
  Status prepare() override { return ends_.prepare(); }
  Status forget() override {  // the factorization may be that of the end
    place(ends_.begin().problem);
    if (Status status = factor(ends_.begin(), x_.t); !status.ok()) return status;
    if (Status status = solve_at_end(); !status.ok()) return status;
    start_from(x_.z);
    return {};
  }

  Status begin() override {
    if (Status status = FixedSteps::begin(); !status.ok()) return status;
    return run_.singular_for > 0 ? Status{} : factor(ends_.begin(), 0);
  }
  Status resume() override {
    velocity_rows_ = velocity_rows(ends_.begin().problem);
    return forget();
  }
  Status leave_singular() override {
    start_from(x_.z);
    velocity_rows_ = velocity_rows(ends_.begin().problem);
    place_beside(ends_.begin().problem);
    return factor(ends_.begin(), x_.t);
  }

  void resize(double before) override { extrapolation_.resize(z_, h_ / before); }
  Status step(double t) override {
    extrapolation_.lead(z_);
    ends_.set_out();
    if (Status status = first_half(t); !status.ok()) return status;
    if (Status status = second_half(t); !status.ok()) return status;
    ends_.take_turns();
    to_and_fro_.watch(run_, x_.v, v_n_, t, h_);
    return {};
  }

  Problem& stand() override {  // the second half has set the position
    Problem& problem = ends_.begin().problem;
    problem.set_velocity(span(x_.v));
    return problem;
  }

  Problem& last_seen() override { return stand(); }

  Status accept(Problem& problem) override {
    bool rewritten = false;
    Status status = problem.accept(x_.t, span(x_.q), span(x_.v), span(rhs_, 0, nv_), span(rhs_, nv_, nc_), rewritten);
    if (!status.ok() || !rewritten) return status;
    to_and_fro_.restart();
    start_from(rhs_);
    velocity_rows_ = velocity_rows(problem);
    place(problem);
    return factor(ends_.begin(), x_.t);
  }

  Status complete() override {
    const Status status = solve_at_end();
    if (status.ok() && h_ * ends_.begin().problem.fastest_turn() < kTurn)
      to_and_fro_.look(run_, x_.a(), x_.t, x_.t >= settings_.end);
    return status;
  }

 private:
  static constexpr double kTurn =
      0.1;  // rad, in a step: beyond, accelerations as coordinates have them turn with a body

  // (a, λ) at the accepted (q, v).
  Status solve_at_end() {
    StepEnds::End& here = ends_.begin();
    here.problem.equations_of_motion(span(zeros_, 0, nv_), {}, x_.a());
    x_.z.head(nv_) = -x_.z.head(nv_);
    here.problem.gamma(x_.lambda());
    return here.system.solve(x_.t, span(x_.z));
  }

  void start_from(const Vector& z) {
    z_ = z;
    extrapolation_.restart(z_);
  }

  Status factor(StepEnds::End& end, double t) {
    return end.system.refresh(t, {}, {}, span(zeros_, 0, nv_), span(zeros_, nv_, nc_));
  }

  // u, λ⁺ and q from q_n, v_n; z = (2 (u − v_n)/h, λ⁺).
  Status first_half(double t) {
    const double position = 0.5 * h_ * h_;
    Problem &begin = ends_.begin().problem, &end = ends_.end().problem;
    broyden_.restart();
    const auto residual = [&](Vector& r) {
      u_.noalias() = v_n_ + (0.5 * h_) * z_.head(nv_);
      dq_.noalias() = h_ * u_;
      end.retract(span(q_n_), span(dq_), span(x_.q));
      begin.set_velocity(span(u_));
      end.set_position(t, span(x_.q));
      begin.equations_of_motion(span(z_, 0, nv_), span(z_, nv_, nc_), span(r, 0, nv_));
      find_even_part(begin);
      r.head(nv_) += e_;
      end.position_residual(span(r, nv_, nc_));
      r.tail(nc_) /= position;
      if (!velocity_rows_.empty()) add_velocity_rows(r);
    };
    const auto matrix = [](Ahead) { return Status{}; };  // has been factored
    const auto correct = [&](Vector& delta) -> Status {
      broyden_.improve(delta);
      z_ += delta;
      return {};
    };
    return newton_.solve(t, position, z_, x_.q, residual, matrix, correct);
  }

  void add_velocity_rows(Vector& r) {
    ends_.begin().problem.velocity_residual(span(rows_));
    for (int row : velocity_rows_) r[nv_ + row] = rows_[row] / h_;
    ends_.end().problem.set_velocity(span(u_));
    ends_.end().problem.velocity_residual(span(rows_));
    for (int row : velocity_rows_) r[nv_ + row] += rows_[row] / h_;
  }

  // e; T(θ)⁻ᵀ = T(−θ)⁻¹.
  void find_even_part(const Problem& problem) {
    problem.momentum(span(u_), span(momentum_));
    e_ = momentum_;
    problem.lower(span(dq_), span(e_));
    e_ -= momentum_;
    rhs_.head(nv_) = momentum_;
    dq_ = -dq_;
    problem.lower(span(dq_), span(rhs_, 0, nv_));
    dq_ = -dq_;
    e_ = (e_ + rhs_.head(nv_) - momentum_) / h_;
  }

  // v from u: linear.
  Status second_half(double t) {
    u_.noalias() = v_n_ + (0.5 * h_) * z_.head(nv_);
    dq_.noalias() = h_ * u_;
    Problem& end = ends_.end().problem;
    end.retract(span(q_n_), span(dq_), span(x_.q));
    end.set_position(t, span(x_.q));
    end.set_velocity(span(u_));
    if (Status status = factor(ends_.end(), t); !status.ok()) return status;
    find_even_part(end);
    end.equations_of_motion(span(zeros_, 0, nv_), {}, span(rhs_, 0, nv_));
    rhs_.head(nv_) = e_ - rhs_.head(nv_);
    end.velocity_residual(span(rhs_, nv_, nc_));
    rhs_.tail(nc_) *= -2 / h_;
    if (Status status = ends_.end().system.solve(t, span(rhs_)); !status.ok()) return status;
    x_.v.noalias() = u_ + (0.5 * h_) * rhs_.head(nv_);
    return {};
  }

  StepEnds ends_;
  NewtonLoop newton_;
  Broyden broyden_;
  std::vector<int> velocity_rows_;
  Vector z_;  // unknowns of the first half; x_.z is the (a, λ) given out
  Extrapolation extrapolation_;
  Vector u_, dq_, e_, momentum_, rows_, rhs_, zeros_;
  ToAndFro to_and_fro_;
};

}  // namespace

std::unique_ptr<Integrator> make_rattle() {
  return std::make_unique<FixedStepIntegrator<Rattle>>();
}

}  // namespace poinsot
