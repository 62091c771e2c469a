// Reads a scene file strictly: the contract of models/scene.schema.json, exact messages, nothing repaired silently.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/scene.h"

namespace poinsot {

// Throws InputError: file, key path, what was found, what is allowed.
Scene read_scene(const std::filesystem::path& file);
// As read_scene, from text; `file` names it in messages.
Scene parse_scene(std::string_view text, std::string_view file);

}  // namespace poinsot
