#include "bench/cases/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "core/counted.h"
#include "core/input_error.h"

namespace poinsot::cases {
namespace fs = std::filesystem;
namespace {

// "; shards 2, 3 of 4 are not among the parts given": by the names of those that are.
std::string absent(const std::vector<fs::path>& parts) {
  std::map<int, std::set<int>> given;  // places by number of shards
  for (const fs::path& part : parts) {
    int place = 0, places = 0;
    if (std::sscanf(part.filename().c_str(), "shard-%d-of-%d.part", &place, &places) == 2) given[places].insert(place);
  }
  if (given.size() != 1 || given.begin()->first > 100'000) return "";
  const auto& [places, there] = *given.begin();
  std::vector<int> missing;
  for (int k = 1; k <= places; ++k)
    if (!there.contains(k)) missing.push_back(k);
  if (missing.empty()) return "; a shard did not come to its end";
  return fmt::format("; of {} shards {} {} not among the parts given", places, fmt::join(missing, ", "),
                     missing.size() == 1 ? "is" : "are");
}

}  // namespace

std::vector<fs::path> parts_in(const std::vector<std::string>& named) {
  std::vector<fs::path> parts;
  const auto add = [&](const fs::path& file) {
    for (const fs::path& other : parts)
      if (std::error_code none; fs::equivalent(other, file, none))
        throw InputError(fmt::format("--merge: {} is given twice, expected each shard once", file.string()));
    parts.push_back(file);
  };
  for (const std::string& name : named) {
    std::error_code none;
    if (!fs::is_directory(name, none)) {
      if (!fs::exists(name, none)) throw InputError(fmt::format("--merge: {}: there is no such file", name));
      add(name);
      continue;
    }
    std::vector<fs::path> inside;
    for (const auto& entry : fs::directory_iterator(name))
      if (entry.path().extension() == ".part") inside.push_back(entry.path());
    std::ranges::sort(inside);
    std::ranges::for_each(inside, add);
  }
  if (parts.empty())
    throw InputError(
        fmt::format("--merge: found no .part in {}, expected those of the shards", fmt::join(named, ", ")));
  return parts;
}

void merge(const std::vector<fs::path>& parts, const Selection& selection, CaseTable& table) {
  for (const fs::path& part : parts) table.read(part, true);
  std::int64_t missing = 0, first = -1;
  for (std::int64_t k = 0; k < selection.size(); ++k) {
    if (table.has(selection.at(k))) continue;
    if (missing++ == 0) first = selection.at(k);
  }
  if (missing > 0)
    throw InputError(fmt::format(
        "--merge: {} of {} cases have no row, the first is case {}{}", missing, selection.size(), first,
        table.unused() == 0 ? absent(parts)
                            : fmt::format("; {} of cases that the study does not have: it or a scene was changed since",
                                          counted(table.unused(), "row is", "rows are"))));
}

}  // namespace poinsot::cases
