// What a scene holds that costs without mattering, in sentences: constraints that follow from others, bodies that do
// not move or never turn, bodies that are fixed to one another.
#pragma once

#include <string>
#include <vector>

#include "bench/study/motion.h"

namespace poinsot::study {

std::vector<std::string> scene_waste(const Scene& scene, const Motion& motion);

}  // namespace poinsot::study
