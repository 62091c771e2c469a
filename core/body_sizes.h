// The size of a body, by which a turn of it is measured as a length.
#pragma once

#include <vector>

#include "core/model.h"

namespace poinsot {

// m, by body: the longest arm of a row on it; bodies without one, or all but, take that of bodies they share rows with.
std::vector<double> body_sizes(const Model& model);

// m, by body: what a gap between it and another one is small beside. A body of microns that hangs on one of metres by
// its centre has arms of metres as far as rank goes; what it is by itself its radius of gyration tells.
std::vector<double> own_sizes(const Model& model);

}  // namespace poinsot
