// Where the time of a step goes, from measured cells: by phase, between the formulations, between the linear solvers.
// Sentences with numbers in them are made from the numbers.
#pragma once

#include <span>

#include "app/measure.h"
#include "app/report.h"

namespace poinsot::app {

// Of cells that differ in mechanism, formulation and jacobian only.
Table phases_table(std::span<const Cell> cells, Analysis analysis);
Table advantage_table(std::span<const Cell> cells, Analysis analysis);

// All linear solvers × mechanisms × formulations × jacobians.
Table linear_solvers_table(std::span<const Cell> cells);
// Every repetition of every cell.
Table raw_table(std::span<const Cell> cells);

}  // namespace poinsot::app
