// Folders that come with the program: beside an installed one (share/poinsot), in the source tree of one that is not.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

namespace poinsot::study {

// Where a folder may be, in the order to look: installed as share/poinsot/NAME, in the source tree as IN_SOURCE.
std::array<std::filesystem::path, 2> program_data(std::string_view name, std::string_view in_source);

}  // namespace poinsot::study
