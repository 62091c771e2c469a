#include "bench/paper/paper_figures.h"

#include <algorithm>

namespace poinsot::paper {
namespace {

// The double pendulum is not in the paper's table: its counts follow from the codes' model file.
constexpr std::array kCounts{PaperCounts{"single_pendulum", 3, 3, 0, 0}, PaperCounts{"double_pendulum", 6, 4, 0, 0},
                             PaperCounts{"four_link", 12, 6, 0, 0}, PaperCounts{"slider_crank", 6, 7, 4, 1}};

constexpr auto kin = Analysis::kinematics;
constexpr auto dyn = Analysis::dynamics;

constexpr std::array kFigures{
    PaperFigures{kin, "single_pendulum", "rp", 1, 1, 3.82, 3.82, 3511, 2131, 0},
    PaperFigures{kin, "single_pendulum", "rA", 2.21, 2.63, 3.80, 3.80, 1503, 935, 0},
    PaperFigures{kin, "single_pendulum", "reps", 1.40, 1.27, 3.80, 3.80, 2047, 1139, 0},
    PaperFigures{kin, "four_link", "rp", 1, 1, 4.47, 4.47, 10840, 5332, 0},
    PaperFigures{kin, "four_link", "rA", 2.38, 2.55, 4.50, 4.50, 4167, 2495, 0},
    PaperFigures{kin, "four_link", "reps", 1.23, 1.10, 4.77, 4.77, 6425, 3347, 0},
    PaperFigures{kin, "slider_crank", "rp", 1, 1, 4.83, 4.83, 13904, 6900, 0},
    PaperFigures{kin, "slider_crank", "rA", 2.70, 2.62, 4.70, 4.70, 4627, 3124, 0},
    PaperFigures{kin, "slider_crank", "reps", 1.47, 1.23, 4.79, 4.79, 6644, 4000, 0},
    PaperFigures{dyn, "single_pendulum", "rp", 1, 1, 2.92, 2.91, 3667, 2453, 3063},
    PaperFigures{dyn, "single_pendulum", "rA", 2.43, 2.46, 2.88, 2.88, 1418, 1105, 1105},
    PaperFigures{dyn, "single_pendulum", "reps", 1.29, 1.69, 2.88, 2.88, 2391, 1499, 1499},
    PaperFigures{dyn, "double_pendulum", "rp", 1, 1, 2.99, 2.93, 6596, 4157, 4727},
    PaperFigures{dyn, "double_pendulum", "rA", 2.63, 2.39, 2.77, 2.77, 2336, 1711, 1711},
    PaperFigures{dyn, "double_pendulum", "reps", 1.21, 1.53, 2.77, 2.77, 4558, 2650, 2650},
    PaperFigures{dyn, "four_link", "rp", 1, 1, 3.09, 3.22, 12508, 6945, 8538},
    PaperFigures{dyn, "four_link", "rA", 2.62, 2.41, 3.01, 3.01, 4524, 3078, 3253},
    // C2 as released needs 12.89 iterations here: its second-order variant scales the residual wrongly.
    PaperFigures{dyn, "four_link", "reps", 1.21, 1.44, 3.20, 3.23, 9133, 17469, 5796},
    PaperFigures{dyn, "slider_crank", "rp", 1, 1, 2.16, 2.14, 13490, 7465, 7465},
    PaperFigures{dyn, "slider_crank", "rA", 2.93, 2.29, 2.31, 2.31, 4920, 3144, 3144},
    PaperFigures{dyn, "slider_crank", "reps", 1.31, 1.30, 2.49, 2.49, 10536, 5339, 5339},
};

constexpr std::array kIterations{OriginalIterations{"rA", 1e-2, 7.63},   OriginalIterations{"rA", 5e-3, 5.86},
                                 OriginalIterations{"rA", 2e-3, 4.43},   OriginalIterations{"rA", 1e-3, 3.75},
                                 OriginalIterations{"rp", 1e-2, 9.16},   OriginalIterations{"rp", 5e-3, 6.82},
                                 OriginalIterations{"rp", 2e-3, 5.04},   OriginalIterations{"rp", 1e-3, 4.24},
                                 OriginalIterations{"reps", 1e-2, 8.78}, OriginalIterations{"reps", 5e-3, 6.80},
                                 OriginalIterations{"reps", 2e-3, 4.97}, OriginalIterations{"reps", 1e-3, 4.18}};

}  // namespace

std::span<const PaperCounts> paper_counts() {
  return kCounts;
}
std::span<const PaperFigures> paper_figures() {
  return kFigures;
}

std::span<const OriginalIterations> original_iterations() {
  return kIterations;
}

const PaperFigures* find_paper_figures(Analysis analysis, std::string_view mechanism, std::string_view formulation) {
  const auto it = std::find_if(kFigures.begin(), kFigures.end(), [&](const PaperFigures& f) {
    return f.analysis == analysis && f.mechanism == mechanism && f.formulation == formulation;
  });
  return it == kFigures.end() ? nullptr : &*it;
}

double PaperFigures::fastest_us() const {
  const double released = std::min(us_c1, us_c2);
  return us_c2_order1 > 0 ? std::min(released, us_c2_order1) : released;
}

}  // namespace poinsot::paper
