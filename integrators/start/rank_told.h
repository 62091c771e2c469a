// What an analysis of rank amounts to where a run begins, in words: notices, stops, and what is refused.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/body_state.h"
#include "core/model.h"
#include "core/status.h"
#include "integrators/settings.h"
#include "integrators/start/rank.h"

namespace poinsot {

// The first few of a list, and what there is to say of each: "a, b, ...".
template <class List, class Say>
std::string first_few(const List& all, Say&& say) {
  constexpr std::size_t kMost = 6;
  std::string text;
  for (std::size_t k = 0; k < all.size() && k < kMost; ++k) text += (k ? ", " : "") + say(all[k]);
  return all.size() > kMost ? text + ", ..." : text;
}

void tell_rank(const Model& model, const RankAnalysis& rank, std::vector<std::string>& notices);

// Throws InputError on redundant rows that do not hold where the others do.
void refuse_conflicts(const Model& model, std::span<const BodyState> states, const RankAnalysis& rank);

// Of a singular position: ok where the run can go on from it as it is meant to.
Status refuse_singular_position(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                                const RankAnalysis& rank, Analysis analysis);

}  // namespace poinsot
