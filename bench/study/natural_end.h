// How long to watch a scene where nobody says: until its quickest body has turned through 15 rad or has travelled 15
// times the mechanism's size (the largest initial |r|; 1 m where that is 0), rounded to 1, 2, 3 or 5 times a power of
// ten. That is 0.03 s of Andrews' mechanism and some seconds of the pendulums. A scene that hardly moves: 1 s.
#pragma once

#include "core/scene.h"

namespace poinsot::study {

double natural_end(const Scene& scene);  // s

}  // namespace poinsot::study
