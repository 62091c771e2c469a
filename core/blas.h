// The BLAS that SuiteSparse calls, whichever the system has put in place when the program is loaded.
//
// Systems here have blocks of a few dozen rows: threads inside BLAS cost more than they give, spoil timings and, where
// they split sums, the promise of the same bytes from the same input. Programs call hold_blas_to_one_thread() first.
#pragma once

#include <string>

namespace poinsot {

// Sets OpenBLAS, BLIS, MKL and OpenMP to one thread, as far as they are loaded.
void hold_blas_to_one_thread();

// The loaded library and, if it has threads, how many it may use now: "libblas.so.3.11.0", "libopenblas.so, 1 thread".
std::string blas();

}  // namespace poinsot
