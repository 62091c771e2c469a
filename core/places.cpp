#include "core/places.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/input_error.h"
#include "core/line_search.h"
#include "core/printable.h"
#include "core/scene_names.h"

namespace poinsot {
namespace {

constexpr std::pair<std::string_view, std::string_view> kKinds[] = {
    {"bodies", "body"}, {"constraints", "constraint"}, {"joints", "joint"}, {"drivers", "driver"}, {"forces", "force"}};

// "body 'rod'", of "bodies" and "rod"
std::string kind_and_name(std::string_view section, std::string_view name) {
  const auto* kind = std::ranges::find(kKinds, section, [](const auto& entry) { return entry.first; });
  return fmt::format("{} '{}'", kind->second, printable(name));
}

// "/joints/17" of "/joints/17/axis", and "joints"; empty where the path is in no element of a section.
std::pair<std::string, std::string_view> element_of(const std::string& path) {
  for (const auto& [section, kind] : kKinds) {
    const std::string begin = fmt::format("/{}/", section);
    if (path.starts_with(begin)) return {path.substr(0, path.find('/', begin.size())), section};
  }
  return {};
}

// Who is where in a scene, by the names that messages know things by.
class Elements {
 public:
  explicit Elements(const Scene& scene) {
    ItemNames rows, forces;
    add(0, scene.bodies, [](const Body& body) { return body.name; });
    add(1, scene.constraints, [&](const Constraint& constraint) { return rows.next(constraint); });
    add(2, scene.joints, [&](const Joint& joint) { return rows.next(joint); });
    add(3, scene.drivers, [&](const Driver& driver) { return rows.next(driver); });
    add(4, scene.forces, [&](const Force& force) { return forces.next(force); });
  }

  // The key path, and the end of the name that begins at `begin` and is closed by a quote; names may hold quotes.
  std::pair<std::string, std::size_t> at(std::size_t kind, std::string_view message, std::size_t begin) const {
    for (std::size_t end = message.find('\'', begin); end != message.npos; end = message.find('\'', end + 1)) {
      const auto found = places_[kind].find(message.substr(begin, end - begin));
      if (found != places_[kind].end()) return {fmt::format("/{}/{}", kKinds[kind].first, found->second), end};
    }
    return {};
  }

 private:
  template <class Item, class Name>
  void add(std::size_t kind, const std::vector<Item>& items, Name name) {
    for (std::size_t k = 0; k < items.size(); ++k) places_[kind].emplace(name(items[k]), k);
  }

  std::map<std::string, std::size_t, std::less<>> places_[std::size(kKinds)];
};

// As the scene gives it; empty where it does not.
std::string name_of(const Scene& scene, std::string_view section, std::size_t k) {
  if (section == "bodies") return scene.bodies.at(k).name;
  if (section == "constraints") return scene.constraints.at(k).name;
  if (section == "joints") return scene.joints.at(k).name;
  if (section == "drivers") return scene.drivers.at(k).name;
  return given_name(scene.forces.at(k));
}

// `inside`, in the parentheses that follow at `at`, or in ones of its own.
void insert(std::string& text, std::size_t at, const std::string& inside) {
  if (text.compare(at, 2, " (") == 0)
    text.insert(at + 2, inside + "; ");
  else
    text.insert(at, fmt::format(" ({})", inside));
}

}  // namespace

void with_lines_of_errors(std::string_view text, const std::function<void()>& read) {
  try {
    read();
  } catch (const ElementError& error) {
    const LineSearch search(text, {error.path()});
    const auto [element, section] = element_of(error.path());
    const std::string name = element.empty() ? "" : search.name(element);
    std::string what = error.what(), where;
    if (!name.empty()) where = kind_and_name(section, name);
    if (const int line = search.line(error.path()); line > 0)
      where += fmt::format("{}line {}", where.empty() ? "" : ", ", line);
    throw InputError(where.empty() ? what : fmt::format("{} ({})", what, where));
  }
}

void with_names_of_errors(const Scene& scene, const std::function<void()>& check) {
  try {
    check();
  } catch (const ElementError& error) {
    const auto [element, section] = element_of(error.path());
    const std::string name =
        element.empty() ? "" : name_of(scene, section, std::stoul(element.substr(section.size() + 2)));
    throw InputError(name.empty() ? error.what() : fmt::format("{} ({})", error.what(), kind_and_name(section, name)));
  }
}

std::string with_key_paths(std::string_view message, const Scene& scene) {
  std::string text(message);
  if (text.starts_with('/')) return text;  // it begins with the one it is about
  std::optional<Elements> elements;
  std::set<std::string> told;
  for (std::size_t at = text.find(" '"); at != text.npos; at = text.find(" '", at + 1)) {
    const std::string_view before = std::string_view(text).substr(0, at);
    for (std::size_t kind = 0; kind < std::size(kKinds); ++kind) {
      const std::string_view word = kKinds[kind].second;
      if (!before.ends_with(word) ||
          (before.size() > word.size() &&
           std::string_view(" (\n").find(before[before.size() - word.size() - 1]) == std::string_view::npos))
        continue;
      if (!elements) elements.emplace(scene);
      const auto [path, end] = elements->at(kind, text, at + 2);
      if (path.empty() || !told.insert(path).second) continue;
      const std::string there = fmt::format(" ({}", path);  // of a sentence that was given them before
      if (text.compare(end + 1, there.size(), there) != 0 ||
          text.find_first_of(",;)", end + 1) != end + 1 + there.size())
        insert(text, end + 1, path);
      break;
    }
  }
  return text;
}

std::string with_lines(std::string_view message, std::string_view text) {
  std::string result(message);
  std::vector<std::pair<std::size_t, std::string>> found;  // where they end
  std::vector<std::string> paths;
  for (std::size_t at = result.find(" (/"); at != result.npos; at = result.find(" (/", at + 1)) {
    const std::size_t begin = at + 2, end = result.find_first_of(");,", begin);
    const std::string path = result.substr(begin, end == result.npos ? end : end - begin);
    if (end == result.npos || result[end] == ',' || element_of(path).first != path) continue;
    found.emplace_back(end, path);
    paths.push_back(path);
  }
  if (found.empty()) return result;
  const LineSearch search(text, paths);
  for (auto one = found.rbegin(); one != found.rend(); ++one)
    if (const int line = search.line(one->second); line > 0) result.insert(one->first, fmt::format(", line {}", line));
  return result;
}

}  // namespace poinsot
