// Names given on the command line with commas between: "rA,rp".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poinsot::app {

// Throws InputError where one is not `known`.
std::vector<std::string> names_in(std::string_view option, const std::string& list, bool (*known)(std::string_view));

}  // namespace poinsot::app
