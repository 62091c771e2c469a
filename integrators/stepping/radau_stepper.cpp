#include "integrators/stepping/radau_stepper.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/stepping/accept.h"
#include "integrators/stepping/step_control.h"
#include "integrators/stepping/turning.h"
#include "integrators/stepping/vectors.h"
#include "linsolve/registry.h"

namespace poinsot {
namespace {

using Matrix = Eigen::Matrix3d;

constexpr int kIterations = 10;
constexpr int kPatience = 30;      // iterations for a sample, which no shorter step takes the place of
constexpr int kSweeps = 3;         // of δq in a Newton iteration
constexpr int kFirstSweeps = 8;    // from the predicted stages
constexpr double kFast = 0.03;     // rate of convergence up to which a matrix is kept
constexpr double kTrusted = 0.05;  // θ/(1 − θ) of the last step below which this step's is not trusted to be
constexpr double kRoundoff = std::numeric_limits<double>::epsilon();

struct Tableau {
  Matrix A;
  Vector3 c, e;  // e: weights of the stages in the error estimate, in units of μ
  double mu;     // real eigenvalue of A
};

Tableau make_tableau() {
  Tableau m;
  const double s = std::sqrt(6.0);
  m.A << (88 - 7 * s) / 360, (296 - 169 * s) / 1800, (-2 + 3 * s) / 225,  //
      (296 + 169 * s) / 1800, (88 + 7 * s) / 360, (-2 - 3 * s) / 225,     //
      (16 - s) / 36, (16 + s) / 36, 1.0 / 9;
  m.c << (4 - s) / 10, (4 + s) / 10, 1;
  m.e << -(13 + 7 * s) / 3, (-13 + 7 * s) / 3, -1.0 / 3;
  m.mu = (6 + std::cbrt(81.0) - std::cbrt(9.0)) / 30;
  return m;
}

const Tableau& tableau() {
  static const Tableau the = make_tableau();
  return the;
}

// The values at x of the polynomials that are 1 at one node c and 0 at the others.
Vector3 lagrange(double x) {
  const Vector3& c = tableau().c;
  Vector3 l;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    l[i] = (x - c[j]) * (x - c[k]) / ((c[i] - c[j]) * (c[i] - c[k]));
  }
  return l;
}

std::span<double> column(Eigen::Matrix<double, Eigen::Dynamic, 3>& m, Eigen::Index k) {
  return {m.col(k).data(), static_cast<std::size_t>(m.rows())};
}

}  // namespace

// The error estimate has order 3, the method 5: with the same tolerance for both, errors would be far smaller than
// asked for. Hairer's code asks the estimate for 0.1 rtol^(2/3).
RadauStepper::RadauStepper(Problem& problem, LinearSystems& systems, double rtol, double atol, Statistics& statistics,
                           PhaseClock& clock)
    : problem_(problem),
      system_(problem, systems.add(Workload::solves), statistics, clock),
      filter_(problem, systems.add(), statistics, clock),
      consistent_(problem, systems.add(Workload::solves), statistics, clock),
      step_(problem),
      within_(problem),
      rtol_(0.1 * std::pow(rtol, 2.0 / 3)),
      atol_(atol / rtol * rtol_),
      nv_(problem.nv()),
      n_(problem.nv() + problem.nc()),
      statistics_(statistics),
      state_(problem),
      next_(problem),
      sample_(problem),
      before_(problem),
      stage_(problem) {
  for (Columns* x : {&Z_, &Z_before_, &R_}) x->setZero(n_, 3);
  for (Columns* x : {&V_, &dQ_, &V_old_, &dQ_old_, &rates_}) x->setZero(nv_, 3);
  for (Vector* x : {&sizes_, &sizes_next_, &scale_, &change_, &e_}) x->setZero(2 * nv_);
  filtered_.setZero(n_);
}

Status RadauStepper::prepare() {
  const std::vector<int> node = problem_.pattern(MatrixKind::consistent).node;
  const int n = static_cast<int>(n_);
  Pattern stages{3 * n, {}, {}}, filter{n, {}, node};
  std::vector<int> unknowns;
  for (int k = 0; k < 3 * n; ++k) {
    unknowns.push_back(k % n);
    stages.node.push_back(node[static_cast<std::size_t>(k % n)]);
  }
  write_stages(step_, 1, n, problem_.nv(), EntryRecorder{stages.blocks});
  write_filter(step_, 1, problem_.nv(), EntryRecorder{filter.blocks});
  if (Status status = system_.prepare(stages, std::move(unknowns)); !status.ok()) return status;
  if (Status status = filter_.prepare(filter); !status.ok()) return status;
  return consistent_.prepare();
}

template <class Sink>
void RadauStepper::write_stages(const Linearized& linear, double h, int n, int nv, Sink&& entry) {
  const Matrix on_D = h * tableau().A, on_K = on_D * on_D;
  for (int i = 0; i < 3; ++i) {
    linear.at[static_cast<std::size_t>(i)].visit(
        [&](int row, int column, double M, double D, double K) {
          for (int j = 0; j < 3; ++j) {
            entry(i * n + row, j * n + column, (i == j ? M : 0.0) + on_D(i, j) * D + on_K(i, j) * K);
          }
        },
        [&](int row, int column, double G) {
          entry(i * n + nv + row, i * n + column, G);
          entry(i * n + column, i * n + nv + row, G);
        });
  }
}

template <class Sink>
void RadauStepper::write_filter(const Linearized& linear, double h, int nv, Sink&& entry) {
  const double hmu = h * tableau().mu;
  linear.at[0].visit([&](int i, int j, double M, double D, double K) { entry(i, j, M + hmu * D + hmu * hmu * K); },
                     [&](int row, int j, double G) {
                       entry(nv + row, j, G);
                       entry(j, nv + row, G);
                     });
}

Status RadauStepper::start(const State& state) {
  state_ = state;
  h_before_ = step_.h = 0;
  return settle();
}

Status RadauStepper::settle() {
  consistent_.stand(state_);
  bool rewritten = false;
  const int revision = problem_.revision();
  if (Status status = accept(problem_, state_, rewritten); !status.ok()) return status;
  if (rewritten) {
    h_before_ = step_.h = 0;  // the stages are those of other coordinates or rows
    convergence_ = 1;
  }
  if (problem_.revision() != revision) {
    step_ = Linearized(problem_), within_ = Linearized(problem_);
    in_solver_ = nullptr;
    if (Status status = prepare(); !status.ok()) return status;
  }
  if (!fast_) step_.h = 0;
  counted_ = problem_.counted_turn().rate;
  component_sizes(problem_, span(state_.q), span(state_.v), span(sizes_));
  return {};
}

Status RadauStepper::cross(double t) {
  state_.t = t;
  if (Status status = consistent_.cross(state_); !status.ok()) return status;
  h_before_ = step_.h = 0;  // the stages are those of other forces
  return settle();
}

double RadauStepper::first_step(double end) const {
  double y = 0, f = 0;
  for (Eigen::Index k = 0; k < nv_; ++k) {
    const double q = atol_ + rtol_ * sizes_[k], v = atol_ + rtol_ * sizes_[nv_ + k];
    y += std::pow(sizes_[k] / q, 2) + std::pow(sizes_[nv_ + k] / v, 2);
    f += std::pow(state_.v[k] / q, 2) + std::pow(state_.z[k] / v, 2);
  }
  return first_trial(std::sqrt(y), std::sqrt(f), end - state_.t);
}

// The problem stands at stage i as it is now, and stage_ says where that is.
void RadauStepper::stand_at_stage(const State& from, double to, Eigen::Index i) {
  stage_.t = i == 2 ? to : from.t + tableau().c[i] * (to - from.t);
  stage_.v = V_.col(i);
  stage_.z = Z_.col(i);
  problem_.retract(span(from.q), column(dQ_, i), span(stage_.q));
  consistent_.stand(stage_);
}

// The matrix of `linear`, linearized at the stages as they are predicted unless it is kept from a step of this length.
Status RadauStepper::refresh(const State& from, double to, Linearized& linear) {
  const double h = to - from.t;
  const bool kept = linear.is_for(h);
  if (kept && in_solver_ == &linear) return {};
  in_solver_ = nullptr;
  Status status = system_.refresh(from.t, [&](std::span<const int> slots, std::span<double> values) {
    for (Eigen::Index i = 0; i < 3 && !kept; ++i) {
      stand_at_stage(from, to, i);
      linear.at[static_cast<std::size_t>(i)].assemble(problem_, stage_.a(), stage_.lambda());
    }
    write_stages(linear, h, static_cast<int>(n_), problem_.nv(), EntryWriter{slots.data(), values.data()});
  });
  linear.h = 0;
  if (status.ok() && !kept && &linear == &step_) {
    status = filter_.refresh(from.t, [&](std::span<const int> slots, std::span<double> values) {
      write_filter(linear, h, problem_.nv(), EntryWriter{slots.data(), values.data()});
    });
  }
  if (!status.ok()) return status;
  linear.h = h;
  in_solver_ = &linear;
  return {};
}

// From the stages of the completed step, or constant.
void RadauStepper::predict(const State& from, double h) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (h_before_ == 0) {
      Z_.col(i) = from.z;
    } else {
      Z_.col(i).noalias() = Z_before_.lazyProduct(lagrange((from.t - before_.t + tableau().c[i] * h) / h_before_));
    }
    dQ_.col(i) = (tableau().c[i] * h) * from.v;
  }
  move(from, h, kFirstSweeps);
}

// v_i and δq_i of the stages' accelerations. (Eigen's other products allocate.)
void RadauStepper::move(const State& from, double h, int sweeps) {
  const Matrix hA = h * tableau().A;
  V_.noalias() = Z_.topRows(nv_).lazyProduct(hA.transpose());
  V_.colwise() += from.v;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    rates_ = V_;
    for (Eigen::Index i = 0; i < 3; ++i) problem_.lower(column(dQ_, i), column(rates_, i));
    dQ_.noalias() = rates_.lazyProduct(hA.transpose());
  }
}

void RadauStepper::set_scale(const State& from, const Vector& q, const Vector& v) {
  component_sizes(problem_, span(from.q), span(from.v), span(sizes_));
  component_sizes(problem_, span(q), span(v), span(sizes_next_));
  scale_.array() = atol_ + rtol_ * sizes_.array().max(sizes_next_.array());
}

Status RadauStepper::stages(const State& from, double to, Linearized& linear) {
  const bool kept = linear.is_for(to - from.t);
  Status status = newton(from, to, linear);
  if (status.ok() || !kept) return status;
  linear.h = 0;  // again with a matrix of its own
  return newton(from, to, linear);
}

// Newton's iteration; ends where what is left, by the rate of convergence θ, is far below the tolerance. A step that
// will not get there is given up soon, because it is tried again with a shorter one.
Status RadauStepper::newton(const State& from, double to, Linearized& linear) {
  const double h = to - from.t;
  predict(from, h);
  if (Status status = refresh(from, to, linear); !status.ok()) return status;
  end_of_step(from, to, stage_);
  set_scale(from, stage_.q, stage_.v);
  const double enough = std::max(10 * kRoundoff / rtol_, std::min(0.03, std::sqrt(rtol_)));
  convergence_ = std::max(std::pow(convergence_, 0.8), kTrusted);
  const bool patient = &linear == &within_;
  double before = 0, rate_before = 0;
  for (int k = 0; k < (patient ? kPatience : kIterations); ++k) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      stand_at_stage(from, to, i);
      consistent_.residual(stage_, column(R_, i));
    }
    if (Status status = system_.solve(from.t, {R_.data(), static_cast<std::size_t>(R_.size())}); !status.ok()) {
      return status;
    }
    V_old_ = V_;
    dQ_old_ = dQ_;
    Z_ -= R_;
    move(from, h, kSweeps);
    ++statistics_.newton_iterations;
    double sum = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      change_ << dQ_.col(i) - dQ_old_.col(i), V_.col(i) - V_old_.col(i);
      sum += std::pow(error_norm(span(change_), span(scale_)), 2);
    }
    const double change = std::sqrt(sum / 3);
    if (!std::isfinite(change)) break;
    if (k > 0) {
      const double ratio = change / before, rate = k == 1 ? ratio : std::sqrt(ratio * rate_before);
      statistics_.convergence.sum += ratio;
      ++statistics_.convergence.count;
      fast_ = rate < kFast;
      if (!patient && rate >= 0.99) break;
      convergence_ = rate < 0.99 ? rate / (1 - rate) : 100;
      if (!patient && convergence_ * change * std::pow(rate, kIterations - 2 - k) > enough) break;
      rate_before = ratio;
    }
    if (convergence_ * change <= enough) {
      fast_ = fast_ || k == 0;
      return {};
    }
    before = std::max(change, kRoundoff);
  }
  return {Failure::not_converged, from.t, {}};  // no words: the step is tried again, and words are allocated
}

Status RadauStepper::attempt(double to, double& error) {
  h_ = to - state_.t;
  if (Status status = stages(state_, to, step_); !status.ok()) return status;
  if (h_ * counted_ >= kMostCounted || turns_too_far(problem_, h_)) {  // it stands at the last stage
    return {Failure::rotation_too_large, to, {}};
  }
  end_of_step(state_, to, next_);
  set_scale(state_, next_.q, next_.v);
  return error_of(state_, h_, error);
}

void RadauStepper::end_of_step(const State& from, double to, State& at) {
  at.t = to;
  at.v = V_.col(2);
  at.z = Z_.col(2);
  problem_.retract(span(from.q), column(dQ_, 2), span(at.q));
}

// x = (1 − hμ J)⁻¹ e, e = hμ f(y_n) + μ Σ e_i (y_i − y_n), J linearized at the first stage.
Status RadauStepper::error_of(const State& from, double h, double& error) {
  const Tableau& m = tableau();
  const double hmu = h * m.mu;
  e_.head(nv_) = hmu * from.v + m.mu * dQ_.lazyProduct(m.e);
  e_.tail(nv_) = hmu * from.z.head(nv_) + m.mu * (V_.lazyProduct(m.e) - m.e.sum() * from.v);
  change_.head(nv_) = e_.head(nv_) + hmu * e_.tail(nv_);
  filtered_.setZero();
  step_.at[0].add_forces(span(e_, nv_, nv_), span(change_, 0, nv_), span(filtered_, 0, nv_));
  if (Status status = filter_.solve(from.t, span(filtered_)); !status.ok()) return status;
  e_.tail(nv_) -= hmu * filtered_.head(nv_);
  e_.head(nv_) += hmu * e_.tail(nv_);
  error = error_norm(span(e_), span(scale_));
  return {};
}

Status RadauStepper::complete(double& error, double most) {
  if (Status status = consistent_.complete(next_); !status.ok()) return status;
  error = std::max(error, error_norm(consistent_.moved_by(), span(scale_)) / consistent_.amplification());
  if (!(error <= most)) return {};
  if (consistent_.leaves_branch(next_)) return {Failure::singular_position, next_.t, {}};
  consistent_.follow(next_);
  before_ = state_;
  std::swap(state_, next_);
  Z_before_ = Z_;
  h_before_ = h_;
  return {};
}

void RadauStepper::take_back() {
  state_ = before_;
  h_before_ = 0;
}

Status RadauStepper::interpolate(double t) {
  within_.h = 0;
  const bool fast = fast_;
  const double convergence = convergence_;
  if (!stages(before_, t, within_).ok()) predict(before_, t - before_.t);  // the polynomial of the completed step
  fast_ = fast;
  convergence_ = convergence;
  end_of_step(before_, t, sample_);
  if (Status status = consistent_.complete(sample_); !status.ok()) return status;
  return consistent_.made_of_rounding(sample_) ? Status{Failure::singular_position, sample_.t, {}} : Status{};
}

}  // namespace poinsot
