// Names with commas between: those given so after an option on the command line, "rA,rp", and those in sentences.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace poinsot::study {

// Throws InputError where one is not among the `known`, and says which are; and where one stands twice.
std::vector<std::string> names_in(std::string_view option, const std::string& list,
                                  const std::vector<std::string>& known);

// "a, b, c and 4 more", where there are more than the `most` that are named.
std::string listed(std::span<const std::string> names, std::size_t most = 8);

}  // namespace poinsot::study
