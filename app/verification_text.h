// What `poinsot run --verify` prints.
#pragma once

#include <cstdio>

#include "bench/study/verification.h"

namespace poinsot::app {

void print(std::FILE* out, const study::Verification& verification);

}  // namespace poinsot::app
