// The constraint rows among which some can depend on others: those of loops.
//
// A body whose rows all lead to one other body (or to the ground), and are independent on it alone, adds nothing that
// could depend on anything: bodies are taken off so, from the ends of trees inwards, until loops are left. Time grows
// linearly with the rows.
#pragma once

#include <vector>

#include "integrators/start/row_space.h"

namespace poinsot {

// The model's numbers, ascending. `all`: its rows, where the bodies stand.
std::vector<int> loop_rows(const Model& model, const RowSpace& all);
std::vector<int> loop_rows(const std::shared_ptr<const Model>& model, double t, std::span<const BodyState> states);

// All rows of a model.
RowSpace all_rows(const std::shared_ptr<const Model>& model, double t, std::span<const BodyState> states);

}  // namespace poinsot
