// What `poinsot run --verify` prints.
#pragma once

#include <cstdio>

#include "bench/study/verification.h"

namespace poinsot::study {

void print(std::FILE* out, const Verification& verification);

}  // namespace poinsot::study
