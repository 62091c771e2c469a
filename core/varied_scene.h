// A scene that was read, for many values of its parameters.
//
//   VariedScene varied(read_scene("pendulum.json"));
//   for (const double l : lengths) simulate(varied.with({{"l", l}}), settings, observe);
//
// Its text is taken apart once and read whole for the first values. For those that follow, read again are only the
// parameters, the tables and those bodies, constraints, joints, drivers and forces that call one of them by name:
// everything else stays as it is.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/json_document.h"
#include "core/scene.h"

namespace poinsot {

// By section, which of its items call parameters or tables by name.
struct CallingItems {
  std::vector<std::size_t> bodies, constraints, joints, drivers, forces;
};

class VariedScene {
 public:
  // Throws InputError where the scene was not read.
  explicit VariedScene(const Scene& scene);

  // What was set before stays set. The scene is without its text, Scene::source, and stays as it is until the next
  // call.
  const Scene& with(const std::map<std::string, double>& values);
  std::string source() const { return document_.text(); }  // with the values set last

 private:
  void read_again();

  std::string name_, text_;
  JsonDocument document_;
  std::map<std::string, std::string> set_;
  CallingItems calling_;
  std::optional<Scene> scene_;  // once it has been read
};

}  // namespace poinsot
