// The user's input is wrong: one sentence with the file and the key path. Thrown while reading only, never by numerics.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace poinsot {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// One about a place of a document, which can still be looked up: its name and its line (core/places.h).
class ElementError : public InputError {
 public:
  ElementError(const std::string& what, std::string path) : InputError(what), path_(std::move(path)) {}
  const std::string& path() const { return path_; }  // "/bodies/2/mass", a JSON pointer

 private:
  std::string path_;
};

}  // namespace poinsot
