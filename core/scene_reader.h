// Reads a scene file strictly: the contract of models/scene.schema.json, exact messages, nothing repaired silently.
//
// Parameters of the scene may be set from outside, as numbers or constant expressions, which may call the others by
// name. What is read says by itself what it is: Scene::source holds the values set and the points of tables in files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "core/scene.h"

namespace poinsot {

using ParameterValues = std::map<std::string, std::string>;  // by name, as a scene file would write them

// Throws InputError: file, key path, what was found, what is allowed.
Scene read_scene(const std::filesystem::path& file, const ParameterValues& set = {});
// As read_scene, from text; `file` names it in messages, and files of tables lie beside it.
Scene parse_scene(std::string_view text, std::string_view file, const ParameterValues& set = {});

// The scene with other values of some of its parameters: VariedScene (core/varied_scene.h) for once, with the text.
// Files are not read again, and what was set before stays set.
Scene with_parameters(const Scene& scene, const std::map<std::string, double>& values);

}  // namespace poinsot
