// Names given with commas between, as after an option on the command line: "rA,rp".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace poinsot::study {

// Throws InputError where one is not among the `known`, and says which are; and where one stands twice.
std::vector<std::string> names_in(std::string_view option, const std::string& list,
                                  const std::vector<std::string>& known);

}  // namespace poinsot::study
