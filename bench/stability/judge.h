// Verdicts over the cells of a family (verdict.h says what they mean).
#pragma once

#include <vector>

#include "bench/stability/family.h"
#include "bench/stability/verdict.h"

namespace poinsot::stability {

// Finds error, promise and verdict of each.
void judge(const Family& family, std::vector<Cell>& cells);

}  // namespace poinsot::stability
