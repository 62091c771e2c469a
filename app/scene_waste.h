// What a scene holds that costs without mattering, in sentences: constraints that follow from others, bodies that do
// not move or never turn, bodies that are fixed to one another.
#pragma once

#include <string>
#include <vector>

#include "app/motion.h"

namespace poinsot::app {

std::vector<std::string> scene_waste(const Scene& scene, const Motion& motion);

}  // namespace poinsot::app
