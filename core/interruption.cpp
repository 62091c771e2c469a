#include "core/interruption.h"

#include <fmt/format.h>

namespace poinsot {

Status interrupted(double t) {
  return {Failure::interrupted, t, fmt::format("interrupted at t = {:.9g} s", t)};
}

}  // namespace poinsot
