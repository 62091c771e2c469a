#include "integrators/start/closed_beside.h"

#include <algorithm>
#include <utility>

#include "core/body_sizes.h"
#include "core/so3.h"
#include "integrators/start/rough_pose.h"

namespace poinsot {
namespace {

constexpr double kMovedAside = 0.05;  // of a body's size, and rad

}  // namespace

ClosedBeside::ClosedBeside(const Model& model, std::span<const BodyState> states)
    : model_(model), states_(states), sizes_(body_sizes(model)), random_(1) {}

bool ClosedBeside::can_be_found() const {
  return states_.size() <= kMostClosed &&
         std::ranges::all_of(model_.rows, [](const Row& row) { return row.f.is_constant(); });
}

std::optional<std::vector<BodyState>> ClosedBeside::next() {
  std::uniform_real_distribution<double> by(-kMovedAside, kMovedAside);
  const auto any = [&] { return Vector3(by(random_), by(random_), by(random_)); };
  std::vector<BodyState> moved(states_.begin(), states_.end());
  for (std::size_t b = 0; b < moved.size(); ++b) {
    moved[b].r += sizes_[b] * any();
    moved[b].A = exp_so3<double>(any()) * moved[b].A;
  }
  ClosedPose pose = close_mechanism(model_, moved);
  if (!pose.closed) return {};
  return std::move(pose.states);
}

}  // namespace poinsot
