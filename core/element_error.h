// An InputError about one place of a document, which can still be looked up: its name and its line (core/places.h).
#pragma once

#include <string>
#include <utility>

#include "core/input_error.h"

namespace poinsot {

class ElementError : public InputError {
 public:
  ElementError(const std::string& what, std::string path) : InputError(what), path_(std::move(path)) {}
  const std::string& path() const { return path_; }  // "/bodies/2/mass", a JSON pointer

 private:
  std::string path_;
};

}  // namespace poinsot
