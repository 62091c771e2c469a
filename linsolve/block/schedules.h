// Schedules by structure: what was found for one matrix serves the next of the same pattern.
//
// A run has several systems of few patterns, and the cases of a study have those of one mechanism over and over; of a
// pendulum's ten steps the order of elimination takes more than a quarter of the instructions. A schedule is a function
// of its pattern alone, so nothing depends on whether it was known. Each thread keeps the newest few, as long as they
// are not of thousands of bodies; those live as long as those who solve by them.
#pragma once

#include <memory>
#include <span>

#include "linsolve/block/schedule.h"

namespace poinsot::block {

// Of the matrix with unknown i in node node[i], where node g is fused with the body node fused[g] (−1: with none).
// Null where Schedule::build refuses.
std::shared_ptr<const Schedule> schedule_of(const CscLayout& layout, std::span<const int> node,
                                            std::span<const int> fused, Fronts kind);

}  // namespace poinsot::block
