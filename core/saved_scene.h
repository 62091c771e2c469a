// A scene as it stands at a later time, written so that running it continues the motion.
//
// Everything stays as the scene file says it but for what depends on when and from which pose the motion starts:
//
//   bodies           stand and move as at time T
//   joints           in the bodies' frames, with the directions that coincide at angle 0
//   angle drivers    the same, and so are torsion springs, whose unloaded angle takes off the full turns made
//   functions of t   of t + T: every `t` in the text of an expression becomes (t + T)
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/body_state.h"
#include "core/scene.h"

namespace poinsot {

// JSON text. `twists`: angle of every torsion spring with its turns, in the order of the scene. Needs scene.source.
// Throws InputError where the scene holds a function of the program, which no file can.
std::string saved_scene(const Scene& scene, double time, std::span<const BodyState> bodies,
                        std::span<const double> twists);

// An expression of t as one of t + by; sums that an earlier save has written are added up.
std::string later(std::string_view expression, double by);

}  // namespace poinsot
