// A scene that a run can start from. What is wrong with its constraints (they conflict, the initial pose is far from
// them) is told here, as the input's fault: runs that are compared with one another keep it as a failure like any
// other.
#pragma once

#include <fmt/format.h>

#include <filesystem>

#include "core/input_error.h"
#include "core/json_document.h"
#include "core/scene_reader.h"

namespace poinsot::study {

// What is refused after a file was read names the file, too.
template <class Act>
decltype(auto) naming(const std::filesystem::path& file, const Act& act) {
  try {
    return act();
  } catch (const InputError& refused) {
    throw InputError(fmt::format("{}: {}", shown_input(file.string()), refused.what()));
  }
}

Scene read_startable_scene(const std::filesystem::path& file, const ParameterValues& set = {});  // throws InputError

}  // namespace poinsot::study
