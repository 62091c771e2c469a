#include "bench/study/name_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/input_error.h"

namespace poinsot::study {

namespace {

// The end of the name that begins at `begin`: of a known one that holds commas itself, or the next comma.
std::size_t name_end(const std::string& list, std::size_t begin, const std::vector<std::string>& known) {
  std::size_t end = std::min(list.find(',', begin), list.size());
  for (const std::string& name : known) {
    const std::size_t after = begin + name.size();
    if (after > end && list.compare(begin, name.size(), name) == 0 && (after == list.size() || list[after] == ','))
      end = after;
  }
  return end;
}

}  // namespace

std::vector<std::string> names_in(std::string_view option, const std::string& list,
                                  const std::vector<std::string>& known) {
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin <= list.size();) {
    const std::size_t end = name_end(list, begin, known);
    const std::string name = list.substr(begin, end - begin);
    if (name.empty() && !list.empty())
      throw InputError(
          fmt::format("{}: a name is missing in \"{}\", expected names with a comma between", option, list));
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
