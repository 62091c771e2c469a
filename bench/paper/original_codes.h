// The time of a step of the paper's two Python codes, C1 and C2, measured when they are run again: by processor, since
// a time says nothing about another one. Ours is divided by them on the same processor only.
#pragma once

#include <span>
#include <string_view>

#include "integrators/settings.h"

namespace poinsot::paper {

struct OriginalTime {
  Analysis analysis;
  std::string_view mechanism, formulation;  // PaperMechanism::file
  double c1, c2;                            // CPU time of a step, µs; C2 as released
  double c2_order1;                         // C2 held to order 1, as the paper describes it; 0: not measured

  double fastest() const;  // of those measured
};

struct OriginalMachine {
  std::string_view processor;  // its model name
  std::string_view about;      // how it was measured
  std::span<const OriginalTime> times;

  // Null where there is none.
  const OriginalTime* find(Analysis analysis, std::string_view mechanism, std::string_view formulation) const;
};
std::span<const OriginalMachine> original_machines();

// The machine whose processor has this model name, as processor() of core/provenance.h reports it; null where there is
// none. Names are the same where they differ in nothing but trade marks, the words "CPU" and "Processor", "@", spaces
// and capitals. (A virtual machine may report a name without a model; then it is as good as that name.)
const OriginalMachine* original_machine(std::string_view processor);

}  // namespace poinsot::paper
