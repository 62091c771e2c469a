// The paper's tables from measured cells, with its own figures and those of its two codes beside ours. Sentences with
// numbers in them are made from the numbers.
#pragma once

#include <span>

#include "app/measure.h"
#include "app/report.h"

namespace poinsot::app {

Table constraint_counts(std::span<const Scene> scenes);  // one per mechanism, in order
// Of cells that differ in mechanism, formulation and jacobian only.
Table speed_up_table(std::span<const Cell> cells, Analysis analysis);
Table iterations_table(std::span<const Cell> cells, Analysis analysis);
Table against_original_table(std::span<const Cell> cells, Analysis analysis);

}  // namespace poinsot::app
