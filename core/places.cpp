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

// A text with insertions; these come in ascending order.
class Inserted {
 public:
  explicit Inserted(std::string_view text) : text_(text) {}

  void at(std::size_t place, std::string_view inside) {
    result_.append(text_.substr(done_, place - done_)).append(inside);
    done_ = place;
  }
  std::string whole() && { return std::move(result_.append(text_.substr(done_))); }

 private:
  std::string_view text_;
  std::string result_;
  std::size_t done_ = 0;  // so much of the text is in the result
};

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
  if (message.starts_with('/')) return std::string(message);  // it begins with the one it is about
  Inserted text(message);
  std::optional<Elements> elements;
  std::set<std::string> told;
  for (std::size_t at = message.find(" '"); at != message.npos; at = message.find(" '", at + 1)) {
    const std::string_view before = message.substr(0, at);
    for (std::size_t kind = 0; kind < std::size(kKinds); ++kind) {
      const std::string_view word = kKinds[kind].second;
      if (!before.ends_with(word) ||
          (before.size() > word.size() &&
           std::string_view(" (\n").find(before[before.size() - word.size() - 1]) == std::string_view::npos))
        continue;
      if (!elements) elements.emplace(scene);
      const auto [path, end] = elements->at(kind, message, at + 2);
      if (path.empty()) continue;
      at = end;  // what stands in the name names nothing
      if (!told.insert(path).second) break;
      const std::string there = fmt::format(" ({}", path);
      const std::string_view after = message.substr(end + 1);
      if (after.starts_with(there) && after.find_first_of(",;)") == there.size()) break;  // it was given them before
      if (after.starts_with(" ("))
        text.at(end + 3, path + "; ");
      else
        text.at(end + 1, there + ")");
      break;
    }
  }
  return std::move(text).whole();
}

std::string with_lines(std::string_view message, std::string_view text) {
  std::vector<std::size_t> ends;
  std::vector<std::string> paths;
  for (std::size_t at = message.find(" (/"); at != message.npos; at = message.find(" (/", at + 1)) {
    const std::size_t begin = at + 2, end = message.find_first_of(");,", begin);
    if (end == message.npos || message[end] == ',') continue;
    std::string path(message.substr(begin, end - begin));
    if (element_of(path).first != path) continue;
    ends.push_back(end);
    paths.push_back(std::move(path));
  }
  if (paths.empty() || !has_lines(text)) return std::string(message);
  const LineSearch search(text, paths);
  Inserted result(message);
  for (std::size_t k = 0; k < paths.size(); ++k)
    if (const int line = search.line(paths[k]); line > 0) result.at(ends[k], fmt::format(", line {}", line));
  return std::move(result).whole();
}

}  // namespace poinsot
