// The stages of a step: their matrices, and Newton's iteration.
#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/stepping/radau_stepper.h"
#include "integrators/stepping/radau_tableau.h"
#include "integrators/stepping/vectors.h"

namespace poinsot {
using Eigen::Matrix3d;
using radau::lagrange;
using radau::tableau;
namespace {

constexpr int kIterations = 10;
constexpr int kPatience = 30;      // iterations for a sample, which no shorter step takes the place of
constexpr int kSweeps = 3;         // of δq in a Newton iteration
constexpr int kFirstSweeps = 8;    // from the predicted stages
constexpr double kFast = 0.03;     // rate of convergence up to which a matrix is kept
constexpr double kTrusted = 0.05;  // θ/(1 − θ) of the last step below which this step's is not trusted to be
constexpr double kRoundoff = std::numeric_limits<double>::epsilon();

}  // namespace

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
  if (Status status = system_.prepare(std::move(stages), std::move(unknowns)); !status.ok()) return status;
  if (Status status = filter_.prepare(std::move(filter)); !status.ok()) return status;
  return consistent_.prepare();
}

template <class Sink>
void RadauStepper::write_stages(const Linearized& linear, double h, int n, int nv, Sink&& entry) {
  const Matrix3d on_D = h * tableau().A, on_K = on_D * on_D;
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
    write_stages(linear, h, static_cast<int>(n_), problem_.nv(), EntryWriter(slots, values));
  });
  linear.h = 0;
  if (status.ok() && !kept && &linear == &step_) {
    status = filter_.refresh(from.t, [&](std::span<const int> slots, std::span<double> values) {
      write_filter(linear, h, problem_.nv(), EntryWriter(slots, values));
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
  const Matrix3d hA = h * tableau().A;
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
      sum += std::pow(norm_(span(change_), span(scale_)), 2);
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

}  // namespace poinsot
