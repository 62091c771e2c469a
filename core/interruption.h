// A request from outside that what is being computed come to an end: a signal, a disk that is full, another thread.
//
// Whatever steps asks once a step and answers with Failure::interrupted; what was computed up to there stands.
#pragma once

#include <atomic>

#include "core/status.h"

namespace poinsot {

// For the whole process, as signals are; a signal handler may set it.
inline std::atomic<bool> interruption_requested{false};

Status interrupted(double t);

}  // namespace poinsot
