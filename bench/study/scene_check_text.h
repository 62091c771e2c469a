// What `poinsot check` says of a scene: for a person, for a program, and in one sentence.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/study/scene_check.h"

namespace poinsot::study {

// Lines. All of it but the derivatives, which are not compared where no run can start.
std::string check_text(const SceneCheck& found);
nlohmann::ordered_json check_json(const SceneCheck& found);  // its keys are documented in app/README.md
// Why the scene is not sound; empty where it is.
std::string verdict(const SceneCheck& found);

}  // namespace poinsot::study
