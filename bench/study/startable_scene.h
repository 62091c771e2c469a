// A scene that a run can start from. What is wrong with its constraints (they conflict, the initial pose is far from
// them) is told here, as the input's fault: runs that are compared with one another keep it as a failure like any
// other.
#pragma once

#include <filesystem>

#include "core/scene_reader.h"

namespace poinsot::study {

Scene read_startable_scene(const std::filesystem::path& file, const ParameterValues& set = {});  // throws InputError

}  // namespace poinsot::study
