#include "core/body_sizes.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace poinsot {

namespace {

std::vector<double> longest_arms(const Model& model) {
  constexpr double kSamePoint = 1e-4;  // of an arm
  std::vector<double> arms(model.bodies.size(), 0.0);
  const auto widen = [&](int body, double arm) {
    if (body != kGround) arms[index(body)] = std::max(arms[index(body)], arm);
  };
  for (const Row& row : model.rows) {
    if (row.type == RowType::DP1 || row.type == RowType::angle) continue;  // without points
    widen(row.i, row.s_i.norm());
    widen(row.j, row.s_j.norm());
    const double d = row.type == RowType::DP2
                         ? (initial_point(model, row.j, row.s_j) - initial_point(model, row.i, row.s_i)).norm()
                         : 0;
    if (d > kSamePoint * std::max(row.s_i.norm(), row.s_j.norm())) widen(row.i, d);
  }
  return arms;
}

}  // namespace

std::vector<double> body_sizes(const Model& model) {
  // Of what lies beside it: less is what a few digits leave of a point that was meant to be the centre.
  constexpr double kPoint = 1e-5;
  const std::vector<double> arms = longest_arms(model);
  std::vector<double> sizes = arms;
  for (const Row& row : model.rows) {  // a body that turns about its centre
    if (row.i == kGround || row.j == kGround) continue;
    const std::size_t i = index(row.i), j = index(row.j);
    if (arms[i] <= kPoint * arms[j]) sizes[i] = std::max(sizes[i], arms[j]);
    if (arms[j] <= kPoint * arms[i]) sizes[j] = std::max(sizes[j], arms[i]);
    if (sizes[i] == 0) sizes[i] = sizes[j];
    if (sizes[j] == 0) sizes[j] = sizes[i];
  }
  const double largest = sizes.empty() ? 0 : *std::ranges::max_element(sizes);
  for (double& size : sizes)
    if (size == 0) size = largest > 0 ? largest : 1;
  return sizes;
}

std::vector<double> own_sizes(const Model& model) {
  constexpr double kSpread = 10;
  const std::vector<double> arms = longest_arms(model);
  std::vector<double> sizes = body_sizes(model);
  for (std::size_t b = 0; b < sizes.size(); ++b) {
    const Body& body = model.bodies[b];
    const double squared = body.mass > 0 ? body.inertia.trace() / body.mass : 0;
    if (squared > 0) sizes[b] = std::min(sizes[b], kSpread * std::max(arms[b], std::sqrt(squared)));
  }
  return sizes;
}

}  // namespace poinsot
