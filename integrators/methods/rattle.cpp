#include "integrators/methods/rattle.h"

#include <utility>

#include "integrators/stepping/broyden.h"
#include "integrators/stepping/newton_loop.h"
#include "integrators/stepping/observe.h"
#include "integrators/stepping/time_grid.h"
#include "integrators/stepping/velocity_rows.h"

namespace poinsot {
namespace {

using Vector = Eigen::VectorXd;

class Run {
 public:
  Run(Problem& problem, LinearSolver& solver, const Settings& settings, State& state, const Observer& observe,
      Statistics& statistics)
      : second_(problem.clone()),
        ends_{{problem, {problem, solver, MatrixKind::consistent, statistics, clock_}},
              {*second_, {*second_, solver, MatrixKind::consistent, statistics, clock_}}},
        state_(state),
        observe_(observe),
        statistics_(statistics),
        grid_(settings),
        h_(grid_.step()),
        newton_(problem, ends_[0].system, settings, Refresh::every_step, statistics),
        broyden_(problem.nv() + problem.nc(), problem.nv()),
        velocity_rows_(velocity_rows(problem)),
        nv_(problem.nv()),
        nc_(problem.nc()),
        x_(state),
        z_(state.z),
        q_n_(state.q),
        v_n_(state.v),
        u_(nv_),
        dq_(nv_),
        e_(nv_),
        momentum_(nv_),
        rows_(nc_),
        rhs_(nv_ + nc_),
        zeros_(Vector::Zero(nv_ + nc_)) {}

  Status operator()() {
    if (Status status = here_->system.prepare(); !status.ok()) return status;
    stand(here_->problem, 0);
    sample(observe_, here_->problem, x_, statistics_);
    clock_.start();
    Status status = factor(*here_, 0);
    for (std::int64_t n = 1; n <= grid_.steps && status.ok(); ++n) {
      const double t = grid_.time(n);
      q_n_.swap(x_.q);
      v_n_.swap(x_.v);
      status = first_half(t);
      if (status.ok()) status = second_half(t);
      if (!status.ok()) {  // the last accepted step stays
        x_.q.swap(q_n_);
        x_.v.swap(v_n_);
        break;
      }
      x_.t = t;
      ++statistics_.steps;
      std::swap(here_, there_);
      if (here_->problem.has_discrete_state()) status = accept(t);
      if (status.ok() && grid_.sampled(n)) status = sample_at(t);
    }
    finish(clock_, statistics_);
    state_ = x_;
    return status;
  }

 private:
  // The two ends of a step take turns: where one ends the next begins, and the problem stands there already.
  struct End {
    Problem& problem;
    StepSystem system;
  };

  void stand(Problem& problem, double t) {
    problem.set_position(t, span(x_.q));
    problem.set_velocity(span(x_.v));
  }
  Status factor(End& end, double t) {
    return end.system.refresh(t, {}, {}, span(zeros_, 0, nv_), span(zeros_, nv_, nc_));
  }

  // u, λ⁺ and q from q_n, v_n; z = (2 (u − v_n)/h, λ⁺).
  Status first_half(double t) {
    const double position = 0.5 * h_ * h_;
    Problem &begin = here_->problem, &end = there_->problem;
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
    const auto matrix = [] { return Status{}; };  // has been factored
    const auto correct = [&](Vector& delta) -> Status {
      broyden_.improve(delta);
      z_ += delta;
      return {};
    };
    return newton_.solve(t, position, x_.q, residual, matrix, correct);
  }

  void add_velocity_rows(Vector& r) {
    here_->problem.velocity_residual(span(rows_));
    for (int row : velocity_rows_) r[nv_ + row] = rows_[row] / h_;
    there_->problem.set_velocity(span(u_));
    there_->problem.velocity_residual(span(rows_));
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
    Problem& end = there_->problem;
    end.retract(span(q_n_), span(dq_), span(x_.q));
    end.set_position(t, span(x_.q));
    end.set_velocity(span(u_));
    if (Status status = factor(*there_, t); !status.ok()) return status;
    find_even_part(end);
    end.equations_of_motion(span(zeros_, 0, nv_), span(zeros_, nv_, nc_), span(rhs_, 0, nv_));
    rhs_.head(nv_) = e_ - rhs_.head(nv_);
    end.velocity_residual(span(rhs_, nv_, nc_));
    rhs_.tail(nc_) *= -2 / h_;
    if (Status status = there_->system.solve(t, span(rhs_)); !status.ok()) return status;
    x_.v.noalias() = u_ + (0.5 * h_) * rhs_.head(nv_);
    z_ = 2 * rhs_ - z_;  // where the next first half begins its iteration: the line through the last two halves
    return {};
  }

  Status accept(double t) {
    here_->problem.set_velocity(span(x_.v));
    bool rewritten = false;
    Status status =
        here_->problem.accept(t, span(x_.q), span(x_.v), span(rhs_, 0, nv_), span(rhs_, nv_, nc_), rewritten);
    if (!status.ok() || !rewritten) return status;
    z_ = rhs_;
    velocity_rows_ = velocity_rows(here_->problem);
    stand(here_->problem, t);
    return factor(*here_, t);
  }

  Status sample_at(double t) {
    Problem& problem = here_->problem;
    problem.set_velocity(span(x_.v));
    problem.equations_of_motion(span(zeros_, 0, nv_), span(zeros_, nv_, nc_), span(x_.z, 0, nv_));
    x_.z.head(nv_) = -x_.z.head(nv_);
    problem.gamma(span(x_.z, nv_, nc_));
    if (Status status = here_->system.solve(t, span(x_.z)); !status.ok()) return status;
    clock_.lap(Phase::other);
    sample(observe_, problem, x_, statistics_);
    clock_.skip();
    return {};
  }

  PhaseClock clock_;
  std::unique_ptr<Problem> second_;
  End ends_[2];
  End *here_ = &ends_[0], *there_ = &ends_[1];
  State& state_;
  const Observer& observe_;
  Statistics& statistics_;
  TimeGrid grid_;
  double h_;
  NewtonLoop newton_;
  Broyden broyden_;
  std::vector<int> velocity_rows_;
  Eigen::Index nv_, nc_;
  State x_;
  Vector z_;  // unknowns of the first half; x_.z is the (a, λ) given out
  Vector q_n_, v_n_, u_, dq_, e_, momentum_, rows_, rhs_, zeros_;
};

class Rattle final : public Integrator {
 public:
  Status run(Problem& problem, LinearSolver& solver, const Settings& settings, State& state, const Observer& observe,
             Statistics& statistics) override {
    return Run(problem, solver, settings, state, observe, statistics)();
  }
};

}  // namespace

std::unique_ptr<Integrator> make_rattle() {
  return std::make_unique<Rattle>();
}

}  // namespace poinsot
