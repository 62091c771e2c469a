#include "app/name_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input_error.h"

namespace poinsot::app {

std::vector<std::string> names_in(std::string_view option, const std::string& list, bool (*known)(std::string_view)) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    names.push_back(list.substr(begin, end - begin));
    if (!known(names.back())) {
      throw InputError(fmt::format("{}: found \"{}\"; `poinsot list` says what there is", option, names.back()));
    }
    begin = end + 1;
  }
  return names;
}

}  // namespace poinsot::app
