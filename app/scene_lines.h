// The lines of a scene's file in what is said of the scene.
#pragma once

#include <string>
#include <string_view>

#include "core/places.h"

namespace poinsot::app {

// The message with the line of each key path in it, as the file stands now.
std::string with_lines_of(const std::string& file, std::string_view message);

}  // namespace poinsot::app
