// The functions of a scene that vary with time by themselves: of drivers, of forces, and laws of springs, which do so
// at a fixed state.
#pragma once

#include <vector>

#include "core/model.h"

namespace poinsot {

// As the scene writes them; what a program computes is left out, nothing of it being known ahead. They live as long as
// the model.
std::vector<const Expression*> functions_of_time(const Model& model);

// As a function of time alone; a law of a spring at elongation 1 and rate 1.
Jet2<double> value_at(const Expression& f, double t);
// |f| at the most from 0 to `end`, by bounds, or by samples where it has none.
double size_until(const Expression& f, double end);

}  // namespace poinsot
