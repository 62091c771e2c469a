// The size of a body, by which a turn of it is measured as a length.
#pragma once

#include <vector>

#include "core/model.h"

namespace poinsot {

// m, by body: the longest arm of a row on it; bodies without one, or all but, take that of bodies they share rows with.
std::vector<double> body_sizes(const Model& model);

}  // namespace poinsot
