// Problems seen densely: any formulation of a model, its matrices without a linear solver, vectors as Eigen's.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "formulations/problem.h"
#include "formulations/registry.h"

namespace poinsot::test {

using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;

inline std::span<const double> view(const VectorX& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}
inline std::span<double> view(VectorX& v) {
  return {v.data(), static_cast<std::size_t>(v.size())};
}

inline std::unique_ptr<Problem> make_problem(std::string_view formulation, const Model& model) {
  return formulations().require(formulation).make(std::make_shared<const Model>(model), {});
}

// Assembled as a linear solver would have it, in a dense array of which everything outside the pattern stays zero.
inline MatrixX assemble(Problem& problem, MatrixKind kind, const StepScale& scale, const VectorX& dq, const VectorX& a,
                        const VectorX& lambda) {
  const Pattern pattern = problem.pattern(kind);
  MatrixX matrix = MatrixX::Zero(pattern.n, pattern.n);
  std::vector<int> slots;
  for (const Block& block : pattern.blocks) {
    for (int c = 0; c < block.cols; ++c) slots.push_back((block.col + c) * pattern.n + block.row);
  }
  problem.assemble(kind, scale, view(dq), view(a), view(lambda), slots,
                   {matrix.data(), static_cast<std::size_t>(matrix.size())});
  return matrix;
}

inline MatrixX gradient(Problem& problem) {
  return assemble(problem, MatrixKind::kinematic, {}, VectorX(), VectorX(), VectorX())
      .topLeftCorner(problem.nc(), problem.nv());
}

// |a − b| relative to the larger of both and of `scale`, in the largest component.
template <class A, class B>
double difference(const Eigen::MatrixBase<A>& of, const Eigen::MatrixBase<B>& from, double scale) {
  const typename A::PlainObject a = of;
  const typename B::PlainObject b = from;
  const double size = std::max({a.template lpNorm<Eigen::Infinity>(), b.template lpNorm<Eigen::Infinity>(), scale});
  const double error = (a - b).template lpNorm<Eigen::Infinity>();
  return std::isfinite(error) ? error / size : std::numeric_limits<double>::infinity();
}

}  // namespace poinsot::test
