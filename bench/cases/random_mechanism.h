// Mechanisms at random, open and closed, of any size: what a claim about "mechanisms" can be tried on.
//
// Bodies are slender bars of random length (0.5 to 1.5 m), direction and mass (0.5 to 2 kg a metre). Each hangs on the
// end of a random bar before it, or on the ground, by a revolute, universal or spherical joint with random axes. Of a
// closed one every third bar instead closes a loop, from the end of the bar before it to a place on the ground:
// universal at its first end and spherical at the other it takes one degree of freedom, and the bar before it hangs on
// a joint that has two or three, so that no constraint depends on the others. All start at rest under gravity in −z.
#pragma once

#include <cstdint>

#include "core/scene.h"

namespace poinsot::cases {

// The same scene of the same arguments, everywhere. Closed ones have at least two bodies.
Scene random_mechanism(int bodies, bool closed, std::uint64_t seed);

}  // namespace poinsot::cases
