// What a sound scene holds that nobody would mean: told, and not refused but for lengths that no run can judge.
#pragma once

#include <string>
#include <vector>

#include "core/model.h"

namespace poinsot {

// Sentences: principal moments that no body has, masses or lengths six orders of magnitude apart, axes that stand in
// another frame than that of their hinge, springs that push their ends apart from one point, numbers whose squares
// overflow. Linear in the model.
std::vector<std::string> scene_doubts(const Model& model);
// The last of these alone, with functions of time as they stand at t: why a run of the model is not finite, or finds no
// step short enough. Empty where there is none.
std::string overflowing(const Model& model, double t = 0);
// The force at t = 0 of a spring whose ends are at one point, N, which has no direction there; 0 of others.
double force_without_direction(const Model& model, const Spring& spring);
// A length of a constraint, or of a body that one holds, whose square overflows, or a direction as long, or as short:
// what rows are worth is judged by those squares, so that no motion of the model can be trusted; and what to write in
// its place. Empty where there is none.
std::string overflowing_length(const Model& model);

}  // namespace poinsot
