// What a formulation is: how the orientation of one body is held, varied and differentiated.
#pragma once

namespace poinsot {

// What kind of space the coordinates q and the velocities v of a formulation make.
enum class CoordinateSpace {
  lie_group,     // v is a velocity of the body itself, not the rate of coordinates: the retraction is no addition
  vector_space,  // q of all bodies is one vector and v = q̇ always: formulas for ordinary equations apply as they are
  charts,        // v = q̇ within a chart; where it becomes singular, accept() rewrites q, v and a in another one
};

}  // namespace poinsot
