// Figures to stand beside ours: those printed in the paper (its tables of constraint counts, speed-ups and iterations)
// and what its two Python codes, C1 and C2, need on a machine when they are run again.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "integrators/settings.h"

namespace poinsot::paper {

struct Mechanism {
  std::string_view title;
  std::string_view file;  // in the models directory, without .json
  bool driven;            // no free degrees of freedom: kinematics can be computed
};

inline constexpr std::array kMechanisms{
    Mechanism{"Single pendulum", "single_pendulum", true}, Mechanism{"Double pendulum", "double_pendulum", false},
    Mechanism{"Four link", "four_link", true}, Mechanism{"Slider crank", "slider_crank", true}};

// Constraints of a mechanism by type, as the paper counts them.
struct PaperCounts {
  std::string_view mechanism;  // Mechanism::file
  int cd, dp1, dp2, d;
};
std::span<const PaperCounts> paper_counts();

// Of one analysis, mechanism and formulation. 0 stands for a figure that is not given.
struct PaperFigures {
  Analysis analysis;
  std::string_view mechanism, formulation;
  double speedup_c1, speedup_c2;        // relative to rp, printed in the paper
  double iterations_c1, iterations_c2;  // a step; kinematics: printed in the paper, dynamics: measured on the codes
  double us_c1, us_c2, us_c2_order1;    // CPU time a step, measured on the codes; C2 as released and held to order 1

  double fastest_us() const;
};
std::span<const PaperFigures> paper_figures();
const PaperFigures* find_paper_figures(Analysis analysis, std::string_view mechanism, std::string_view formulation);

// Newton iterations a step of the original codes, four link, dynamics over 1 s with steps of exactly h and tolerance
// 1e-11/h², measured on them. Those of rp are the second code's, whose residual has p_n λ_p for p λ_p: without that an
// emulation of it needs 7.62, 6.15, 4.54 and 4.04.
struct OriginalIterations {
  std::string_view formulation;
  double step, iterations;
};
std::span<const OriginalIterations> original_iterations();

// Where the codes were measured.
inline constexpr std::string_view kOriginalMachine =
    "Intel Xeon 2.50 GHz, Python 3.11.2, numpy 1.24.2, scipy 1.10.1, one BLAS thread, CPU time, median of 3 "
    "interleaved "
    "repetitions of 1 s simulated at h = 1e-3";

}  // namespace poinsot::paper
