#include "integrators/start/row_choice.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "integrators/start/grouped_rows.h"
#include "integrators/start/row_blocks.h"

namespace poinsot {

RowChoice::RowChoice(std::shared_ptr<const Model> model, std::vector<int> rows, std::vector<int> aside, Steps steps)
    : space_(model, std::move(rows), RowSpace::Use::choice), aside_(std::move(aside)) {
  const std::vector<int> turns = opening_turns(*model);
  const Lists blocks = row_blocks(*model, space_.rows());
  for (int b = 0; b < blocks.size(); ++b) {
    const auto is_aside = [&](int k) { return std::ranges::binary_search(aside_, space_.rows()[index(k)]); };
    if (std::ranges::any_of(blocks[b], is_aside))
      blocks_.emplace_back(*model, space_, std::vector<int>(blocks[b].begin(), blocks[b].end()), aside_, turns, steps);
  }
  renewed_.assign(blocks_.size(), 0);
}

void RowChoice::take_good_for() {
  good_for_ = HUGE_VAL;
  for (const BlockChoice& block : blocks_) good_for_ = std::min(good_for_, block.good_for());
}

void RowChoice::look(double t, std::span<const BodyState> states) {
  space_.stand(t, states);
  for (BlockChoice& block : blocks_) block.look(space_);
  take_good_for();
}

bool RowChoice::worn() const {
  return std::ranges::any_of(blocks_, &BlockChoice::worn);
}

bool RowChoice::renew(double t, std::span<const BodyState> states, double turned, double ahead, bool asked) {
  space_.stand(t, states);
  bool any = false;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    renewed_[b] = blocks_[b].renew(space_, turned, ahead, asked);
    any = any || renewed_[b];
  }
  take_good_for();
  if (!any) return false;
  aside_.clear();
  for (const BlockChoice& block : blocks_) block.add_aside(space_, aside_);
  std::ranges::sort(aside_);
  return true;
}

void RowChoice::carry_over(std::span<double> lambda) {
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (renewed_[b]) blocks_[b].carry_over(space_, lambda);
}

std::size_t RowChoice::place_of(int row) const {
  return index(std::ranges::lower_bound(space_.rows(), row) - space_.rows().begin());
}

double RowChoice::size_of(int row) const {
  constexpr double kFull = 1e-2;  // where a gradient all but vanishes Φ goes with the square of the distance
  const std::size_t k = place_of(row);
  return space_.own_size_of_row(k) * std::max(space_.norm_of_row(k), kFull * space_.full_norm(k));
}

bool RowChoice::has_null_vectors() const {
  return std::ranges::all_of(blocks_, &BlockChoice::has_null_vectors);
}

std::vector<int> RowChoice::groups_of_redundant_loops(const Model& model) const {
  std::vector<char> any(model.groups.size(), 0);
  for (const BlockChoice& block : blocks_)
    block.for_each_row(space_, [&](int row) { any[index(model.rows[index(row)].group)] = 1; });
  std::vector<int> groups;
  for (std::size_t g = 0; g < any.size(); ++g)
    if (any[g]) groups.push_back(static_cast<int>(g));
  return groups;
}

std::vector<SparseEntries> RowChoice::null_vectors(double t, std::span<const BodyState> states) {
  space_.stand(t, states);
  std::vector<SparseEntries> vectors;
  for (BlockChoice& block : blocks_) block.add_null_vectors(space_, vectors);
  return vectors;
}

}  // namespace poinsot
