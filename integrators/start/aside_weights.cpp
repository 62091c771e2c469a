#include "integrators/start/aside_weights.h"

#include <algorithm>

#include "core/index.h"

namespace poinsot {
namespace {

constexpr double kAtRest = 0.3;  // a judgement: small beside 1, and yet no reason for choices with large coefficients

}  // namespace

std::vector<double> aside_weights(const Model& model, std::span<const int> rows) {
  const auto row = [&](int k) -> const Row& { return model.rows[index(k)]; };
  const bool carried = std::ranges::none_of(rows, [&](int k) { return row(k).i == kGround || row(k).j == kGround; });
  std::vector<double> weights;
  weights.reserve(rows.size());
  for (const int k : rows) weights.push_back(carried && row(k).type == RowType::CD ? kAtRest : 1.0);
  return weights;
}

}  // namespace poinsot
