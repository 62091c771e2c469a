// What a sound scene holds that nobody would mean: told, never refused.
#pragma once

#include <string>
#include <vector>

#include "core/model.h"

namespace poinsot {

// Sentences: principal moments that no body has, masses or lengths six orders of magnitude apart, axes that stand in
// another frame than that of their hinge, numbers whose squares overflow. Linear in the model.
std::vector<std::string> scene_doubts(const Model& model);
// The last of these alone, with functions of time as they stand at t: why a run of the model is not finite, or finds no
// step short enough. Empty where there is none.
std::string overflowing(const Model& model, double t = 0);

}  // namespace poinsot
