// Where the time of a step goes, from measured cells: by phase, between the formulations, between the linear solvers.
// Sentences with numbers in them are made from the numbers.
#pragma once

#include <span>

#include "bench/study/measure.h"
#include "bench/study/report.h"

namespace poinsot::paper {

// Of cells that differ in mechanism, formulation and jacobian only.
study::Table phases_table(std::span<const study::Cell> cells, Analysis analysis);
study::Table advantage_table(std::span<const study::Cell> cells, Analysis analysis);

// All linear solvers × mechanisms × formulations × jacobians.
study::Table linear_solvers_table(std::span<const study::Cell> cells);
// Every repetition of every cell.
study::Table raw_table(std::span<const study::Cell> cells);

}  // namespace poinsot::paper
