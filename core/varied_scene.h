// A scene that was read, for many values of its parameters.
//
//   VariedScene varied(read_scene("pendulum.json"));
//   for (const double l : lengths) simulate(varied.with({{"l", l}}), settings, observe);
//
// Its text is taken apart once, and read again are only the parameters, the tables and those bodies, constraints,
// joints, drivers and forces that call one of them by name: everything else stays as it is.
#pragma once

#include <cstddef>
#include <map>
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

  // As with_parameters() of core/scene_reader.h, but without the text: Scene::source is empty. What was set before
  // stays set. The scene stays as it is until the next call.
  const Scene& with(const std::map<std::string, double>& values);

 private:
  void vary(std::map<std::string, std::string> set);

  std::string name_, text_;
  JsonDocument document_;
  CallingItems calling_;
  Scene scene_;
};

}  // namespace poinsot
