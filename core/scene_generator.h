// Scenes of any size for scaling studies: chains, trees, ladders of closed loops, the N-four-bar.
//
// All are made of equal slender rods (1 m, 1 kg, J̄ = diag(1e-3, 1/12, 1/12), local x along the rod) under gravity in
// −z, start at rest (the N-four-bar moving) and have no dependent constraints: loops are closed by universal and
// spherical joints where revolutes alone would over-constrain them.
#pragma once

#include <span>
#include <string_view>

#include "core/scene.h"

namespace poinsot {

struct SceneGenerator {
  std::string_view name;
  std::string_view about;
  // At least `bodies` bodies; at most one cell of the structure more.
  Scene (*make)(int bodies);
};

std::span<const SceneGenerator> scene_generators();
const SceneGenerator* find_scene_generator(std::string_view name);  // nullptr where no entry has the name

}  // namespace poinsot
