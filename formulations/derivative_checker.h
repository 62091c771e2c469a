// The derivative check of a formulation (formulations/derivative_check.h): the residuals on dual numbers on one side,
// the formulas of its Problem on the other.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/dual.h"
#include "core/scene_doubts.h"
#include "formulations/derivative_check.h"
#include "formulations/mechanism.h"
#include "formulations/model_part.h"
#include "formulations/registry.h"

namespace poinsot {

// Of one part of a model, in formulation F.
template <Formulation F>
class DerivativeChecker {
 public:
  DerivativeChecker(const Part& part, std::string name, std::vector<DerivativeCheck>& out)
      : part_(part),
        name_(std::move(name)),
        out_(out),
        problem_(formulations().require(F::name).make(std::make_shared<const Model>(part.model), {})),
        duals_(std::make_shared<const Elements>(std::make_shared<const Model>(part.model), std::span<const int>())),
        q_(problem_->nq()),
        v_(problem_->nv()) {
    problem_->from_bodies(part.states, view(q_), view(v_));
    problem_->set_position(0, view(q_));
    problem_->set_velocity(view(v_));
  }

  void rows() {
    const int nv = problem_->nv(), nc = problem_->nc(), rows = static_cast<int>(part_.model.rows.size());
    const Matrix difference = matrix({0, 1, 1}) - derivatives({0, 1, 1});
    const Matrix entries = matrix({0, 1, 1});
    Vector velocity(nc), gamma(nc), nu(nc);
    problem_->velocity_residual(view(velocity));
    problem_->nu(view(nu));
    problem_->gamma(view(gamma));
    stand(D(0.0, 1.0), v_, Vector::Zero(nv));
    const Vector position_rate = duals([&](D* out) { duals_.constraint_residual(D(1.0), D(0.0), out); });
    const Vector velocity_rate = duals([&](D* out) { duals_.velocity_residual(out); });

    double gradient_error = 0, nu_error = 0, gamma_error = 0, reaction_size = 0;
    for (int k = 0; k < rows; ++k) {
      const Row& row = part_.model.rows[static_cast<std::size_t>(k)];
      const TermSize size = term_size(part_, row);
      worst(gradient_error, difference.row(nv + k), std::max(size.value, largest(entries.row(nv + k))));
      if (row.type != RowType::pfaffian) {  // which has no Φ
        worst(nu_error, Vector::Constant(1, velocity[k] - position_rate[k]),
              std::max({size.rate, std::abs(nu[k]), std::abs(velocity[k])}));
      }
      worst(gamma_error, Vector::Constant(1, gamma[k] + velocity_rate[k]), std::max(size.second, std::abs(gamma[k])));
      reaction_size += size.value;
    }
    double reaction_error = 0;
    worst(reaction_error, difference.topRows(nv), std::max(reaction_size, largest(entries.topRows(nv))));
    report("gradient", gradient_error);
    report("nu", nu_error);
    report("gamma", gamma_error);
    report("variation of the reaction", reaction_error);
  }

  void force(double tolerance = kDerivativeTolerance) {
    const Vector zero = Vector::Zero(problem_->nv()), no_lambda = Vector::Zero(problem_->nc());
    Vector load(problem_->nv());
    problem_->equations_of_motion(view(zero), view(no_lambda), view(load));
    for (const auto& [what, scale] : {std::pair("variation with the position", StepScale{0, 0, 1}),
                                      std::pair("variation with the velocity", StepScale{0, 1, 0})}) {
      const Matrix entries = matrix(scale).topRows(problem_->nv());
      double error = 0;
      worst(error, entries - derivatives(scale).topRows(problem_->nv()), std::max(largest(load), largest(entries)));
      report(what, error, tolerance);
    }
  }

 private:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;
  using D = Dual<double>;
  using DualVector = Eigen::Matrix<D, Eigen::Dynamic, 1>;

  static std::span<const double> view(const Vector& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
  static std::span<double> view(Vector& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
  static DualVector dual(const Vector& value, const Vector& direction) {
    DualVector x(value.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = D(value[k], direction[k]);
    return x;
  }
  static Vector derivative(const DualVector& x) {
    return Vector::NullaryExpr(x.size(), [&](Eigen::Index k) { return x[k].d; });
  }

  template <class Derived>
  static double largest(const Eigen::MatrixBase<Derived>& m) {
    return m.size() == 0 ? 0 : m.cwiseAbs().maxCoeff();
  }
  // NaN counts as the worst there is.
  template <class Derived>
  static void worst(double& error, const Eigen::MatrixBase<Derived>& difference, double size) {
    if (!difference.allFinite()) error = std::numeric_limits<double>::infinity();
    const double found = largest(difference);
    if (found > 0) error = std::max(error, found / size);
  }
  void report(std::string_view what, double error, double tolerance = kDerivativeTolerance) {
    out_.push_back({name_, what, error, error <= tolerance});
  }

  // The columns of the bodies in the Newton matrix of `scale`, by formula: a = 0, λ = 1 for every row of the model.
  Matrix matrix(const StepScale& scale) {
    const Pattern pattern = problem_->pattern(MatrixKind::exact);
    std::vector<int> slots;
    for (const Block& block : pattern.blocks) {
      for (int c = 0; c < block.cols; ++c) slots.push_back((block.col + c) * pattern.n + block.row);
    }
    Matrix m = Matrix::Zero(pattern.n, pattern.n);
    const Vector a = Vector::Zero(problem_->nv()), lambda = multipliers();
    problem_->assemble(MatrixKind::exact, scale, {}, view(a), view(lambda), slots,
                       {m.data(), static_cast<std::size_t>(m.size())});
    return m.leftCols(problem_->nv());
  }
  // The same by dual numbers, column by column. Constraint rows are those of scale {·, 1, 1}.
  Matrix derivatives(const StepScale& scale) {
    const int nv = problem_->nv(), nc = problem_->nc();
    Matrix m(nv + nc, nv);
    const DualVector a = dual(Vector::Zero(nv), Vector::Zero(nv)), lambda = dual(multipliers(), Vector::Zero(nc));
    const StepScale unscaled{0, 1, 1};
    for (int k = 0; k < nv; ++k) {
      const Vector direction = Vector::Unit(nv, k);
      stand(D(0.0), scale.position * direction, scale.velocity * direction);
      DualVector out(nv + nc);
      duals_.residual(a.data(), lambda.data(), out.data(), &unscaled, out.data() + nv);
      m.col(k) = derivative(out);
    }
    return m;
  }
  Vector multipliers() const {
    Vector lambda = Vector::Zero(problem_->nc());
    lambda.head(static_cast<Eigen::Index>(part_.model.rows.size())).setOnes();
    return lambda;
  }

  void stand(const D& t, const Vector& dq, const Vector& dv) {
    const DualVector from = dual(q_, Vector::Zero(q_.size())), by = dual(Vector::Zero(dq.size()), dq);
    dual_q_.resize(q_.size());
    dual_v_ = dual(v_, dv);
    duals_.retract(from.data(), by.data(), dual_q_.data(), duals_.nb());
    duals_.set_position(t, dual_q_.data());
    duals_.set_velocity(dual_v_.data());
  }
  template <class Function>
  Vector duals(Function&& write) {
    DualVector out(duals_.nc());
    write(out.data());
    return derivative(out);
  }

  const Part& part_;
  std::string name_;
  std::vector<DerivativeCheck>& out_;
  std::unique_ptr<Problem> problem_;
  Mechanism<F, D> duals_;
  Vector q_, v_;
  DualVector dual_q_, dual_v_;
};

template <class F>
std::vector<DerivativeCheck> check_derivatives_in(const Model& model, std::span<const BodyState> states) {
  check(states.size() == model.bodies.size(), "the derivative check has a state for every body");
  static constexpr std::string_view kKinds[] = {"constraint", "joint", "driver"};
  std::vector<DerivativeCheck> out;
  const auto named = [](std::string_view kind, const std::string& name) {
    return std::string(kind) + " '" + name + "'";
  };
  for (const Group& group : model.groups) {
    const Part part = part_of(model, states, group);
    DerivativeChecker<F>(part, named(kKinds[static_cast<int>(group.kind)], group.name), out).rows();
  }
  const auto force = [&](const auto& element, const std::string& name) {
    const Part part = part_of(states, element);
    DerivativeChecker<F>(part, named("force", name), out).force();
  };
  for (const PointForce& element : model.point_forces) force(element, element.name);
  for (const Torque& element : model.torques) force(element, element.name);
  for (const Spring& element : model.springs)
    if (force_without_direction(model, element) == 0) force(element, element.name);
  for (const TorsionElement& element : model.torsions) force(element, element.spring.name);
  for (const LinearDrag& element : model.drags) force(element, element.name);
  for (const CallbackForce& element : model.callbacks) {
    const Part part = part_of(states, element);
    DerivativeChecker<F>(part, named("force", element.name), out)
        .force(element.sensitivity ? kDerivativeTolerance : kDifferenceTolerance);
    if (!element.sensitivity) continue;
    const double error = sensitivity_error(part.model.callbacks.front(), part.states);
    out.push_back({named("force", element.name), "sensitivity", error, error <= kDifferenceTolerance});
  }
  return out;
}

}  // namespace poinsot
