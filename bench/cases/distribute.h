// Cases spread over the ranks of an MPI job.
//
// Rank 0 reads the study, hands out cases and writes the rows; it computes, too. The others need nothing but the
// program: the study comes to them with its scenes. They ask for cases before they run out of them, so many at a time
// as take about a twentieth of a second, and send rows at least every fiftieth of a second. A rank that dies takes the
// job with it, as MPI does; what it had sent is kept.
//
// Messages to rank 0: 'W' wants cases, 'R' rows, 'I' it was interrupted, 'B' it has nothing more to do; all bring rows:
// "NUMBER FAILED LINE" for each. From rank 0: numbers of cases, 8 bytes each; none: there are no more.
#pragma once

#include <functional>

#include "bench/cases/executor.h"
#include "bench/cases/ranks.h"

namespace poinsot::cases {

// Of rank 0: as run_threads(), with the others. Throws study::OutputError.
void lead(Ranks& ranks, const Study& study, References& references, int threads, Undone& undone,
          const std::function<void(CaseRow&&)>& put, const std::function<void()>& meanwhile);

// Of the others, until rank 0 has no more. False: interrupted.
bool follow(Ranks& ranks, const Study& study, References& references, int threads);

// The study for all, from rank 0; nothing where it has none (its input was wrong). Throws InputError where this is
// another program than rank 0's.
void share(Ranks& ranks, std::string& content);

}  // namespace poinsot::cases
