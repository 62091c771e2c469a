// Numbers to stand beside ours that no machine decides: those printed in the paper (its tables of constraint counts,
// speed-ups and iterations) and the iterations of its two Python codes, C1 and C2, where it prints none.
#pragma once

#include <span>
#include <string_view>

#include "integrators/settings.h"

namespace poinsot::paper {

// Constraints of a mechanism by type, as the paper counts them.
struct PublishedCounts {
  std::string_view mechanism;  // PaperMechanism::file
  int cd, dp1, dp2, d;
};
std::span<const PublishedCounts> published_counts();  // in the order of kMechanisms

// Of one analysis, mechanism and formulation. 0 stands for what is not given.
struct Published {
  Analysis analysis;
  std::string_view mechanism, formulation;
  double speedup_c1, speedup_c2;        // relative to rp, printed in the paper
  double iterations_c1, iterations_c2;  // a step; kinematics: printed in the paper, dynamics: measured on the codes
};
// Null where there is nothing.
const Published* find_published(Analysis analysis, std::string_view mechanism, std::string_view formulation);

// Newton iterations a step of the original codes, four link, dynamics over 1 s with steps of exactly h and tolerance
// 1e-11/h², measured on them. Those of rp are the second code's, whose residual has p_n λ_p for p λ_p: without that an
// emulation of it needs 7.62, 6.15, 4.54 and 4.04.
struct OriginalIterations {
  std::string_view formulation;
  double step, iterations;
};
std::span<const OriginalIterations> original_iterations();

}  // namespace poinsot::paper
