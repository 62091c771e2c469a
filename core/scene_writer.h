// Writes a scene of bodies and joints, as core/scene_generator.h makes them, in the form of the scene contract.
#pragma once

#include <string>

#include "core/scene.h"

namespace poinsot {

// Joints may be in the bodies' frames. JSON text that read_scene() turns into the same scene, to the last bit. One line
// per body and per joint.
std::string to_json(const Scene& scene);

}  // namespace poinsot
