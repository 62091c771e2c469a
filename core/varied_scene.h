// A scene that was read, for many values of its parameters: its text is taken apart once.
#pragma once

#include <map>
#include <string>

#include "core/json_document.h"
#include "core/scene.h"

namespace poinsot {

class VariedScene {
 public:
  // Throws InputError where the scene was not read.
  explicit VariedScene(const Scene& scene);

  // As with_parameters() of core/scene_reader.h, always of the same parameters, but without the text: Scene::source is
  // empty.
  Scene with(const std::map<std::string, double>& values);

 private:
  std::string name_;
  JsonDocument document_;
};

}  // namespace poinsot
