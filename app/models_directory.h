// Where the mechanisms of the paper are: beside an installed program, or in the source tree of one that is not.
#pragma once

#include <filesystem>
#include <string>

namespace poinsot::app {

// `given` if it is not empty. Throws InputError where the place holds no models.
std::filesystem::path models_directory(const std::string& given);

}  // namespace poinsot::app
