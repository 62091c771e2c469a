// The user's input is wrong: one sentence with the file and the key path. Thrown while reading only, never by numerics.
#pragma once

#include <stdexcept>

namespace poinsot {

class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace poinsot
