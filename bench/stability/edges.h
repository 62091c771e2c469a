// The families, by what they are about. Adding one: a function there, and its place in the list at the file's end.
#pragma once

#include "bench/stability/family.h"

namespace poinsot::stability {

std::vector<Family> edges_of_rotation();
std::vector<Family> edges_of_loops();  // and drivers
std::vector<Family> edges_of_sizes();  // numbers of very different size
std::vector<Family> edges_of_runs();   // starts, forces, long runs

}  // namespace poinsot::stability
