// Units of rows by masses: every body's block M has entries of one in them, and rows of constraints G over it.
//
// In these units elimination of bodies and then of constraints is stable. In mechanisms that are light or small M is
// tiny beside G once the whole matrix is equilibrated (equilibration.h), and pivots of G pass for better ones than
// pivots of M: numbers grow by 10 to 100 where bodies and rows share fronts, and residuals with them.
#pragma once

#include <span>
#include <vector>

#include "linsolve/csc_layout.h"

namespace poinsot::block {

// Of a matrix with unknown i in node[i], a body or a group of constraints; `columns` are the factors of an
// equilibration, to begin with.
std::vector<double> mass_units(const CscLayout& layout, std::span<const double> values, std::span<const int> node,
                               std::span<const double> columns);

}  // namespace poinsot::block
