#include "bench/study/name_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/input_error.h"

namespace poinsot::study {

std::vector<std::string> names_in(std::string_view option, const std::string& list,
                                  const std::vector<std::string>& known) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    const std::string name = list.substr(begin, end - begin);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw InputError(fmt::format("{}: found \"{}\", expected one or more of {}, with commas between", option, name,
                                   fmt::join(known, ", ")));
    }
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw InputError(fmt::format("{}: found \"{}\" twice, expected each name once", option, name));
    names.push_back(name);
    begin = end + 1;
  }
  return names;
}

std::string listed(std::span<const std::string> names, std::size_t most) {
  const std::string text = fmt::format("{}", fmt::join(names.first(std::min(most, names.size())), ", "));
  return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

}  // namespace poinsot::study
