#include "app/name_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/input_error.h"

namespace poinsot::app {

std::vector<std::string> names_in(std::string_view option, const std::string& list,
                                  const std::vector<std::string>& known) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    names.push_back(list.substr(begin, end - begin));
    if (std::find(known.begin(), known.end(), names.back()) == known.end()) {
      throw InputError(fmt::format("{}: found \"{}\", expected one or more of {}, with commas between", option,
                                   names.back(), fmt::join(known, ", ")));
    }
    begin = end + 1;
  }
  return names;
}

}  // namespace poinsot::app
