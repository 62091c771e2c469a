// Names given on the command line with commas between: "rA,rp".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poinsot::app {

// Throws InputError where one is not among the `known`, and says which are; and where one stands twice.
std::vector<std::string> names_in(std::string_view option, const std::string& list,
                                  const std::vector<std::string>& known);

}  // namespace poinsot::app
