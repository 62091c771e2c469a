// The scenes of a study: files, made ones, and mechanisms at random, as its file names them (bench/cases/README.md).
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "bench/cases/study_file.h"
#include "core/json_document.h"

namespace poinsot::cases {

using SceneOf = std::function<Scene(const std::string& file)>;

// Appends those of `root`'s "scenes", with what their readers noticed. Throws InputError with file and key path.
void read_scenes(Study& study, const JsonValue& root, std::uint64_t seed, const SceneOf& scene_of);

}  // namespace poinsot::cases
