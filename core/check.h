// A check that stops: for conditions that only a bug of this program can violate.
//
// Three kinds of failure, three mechanisms: bad input is an InputError (core/input_error.h), failing numerics are a
// Status (core/status.h), and a broken promise between two parts of the program is a std::logic_error thrown here.
#pragma once

#include <stdexcept>
#include <string>

namespace poinsot {

inline void check(bool condition, const char* promise) {
  if (!condition) throw std::logic_error(std::string("internal error, please report: ") + promise);
}

}  // namespace poinsot
