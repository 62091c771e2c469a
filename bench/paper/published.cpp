#include "bench/paper/published.h"

#include <algorithm>
#include <array>

namespace poinsot::paper {
namespace {

// The double pendulum is not in the paper's table: its counts follow from the codes' model file.
constexpr std::array kCounts{PublishedCounts{"single_pendulum", 3, 3, 0, 0},
                             PublishedCounts{"double_pendulum", 6, 4, 0, 0}, PublishedCounts{"four_link", 12, 6, 0, 0},
                             PublishedCounts{"slider_crank", 6, 7, 4, 1}};

constexpr auto kin = Analysis::kinematics;
constexpr auto dyn = Analysis::dynamics;

constexpr std::array kPublished{
    Published{kin, "single_pendulum", "rp", 1, 1, 3.82, 3.82},
    Published{kin, "single_pendulum", "rA", 2.21, 2.63, 3.80, 3.80},
    Published{kin, "single_pendulum", "reps", 1.40, 1.27, 3.80, 3.80},
    Published{kin, "four_link", "rp", 1, 1, 4.47, 4.47},
    Published{kin, "four_link", "rA", 2.38, 2.55, 4.50, 4.50},
    Published{kin, "four_link", "reps", 1.23, 1.10, 4.77, 4.77},
    Published{kin, "slider_crank", "rp", 1, 1, 4.83, 4.83},
    Published{kin, "slider_crank", "rA", 2.70, 2.62, 4.70, 4.70},
    Published{kin, "slider_crank", "reps", 1.47, 1.23, 4.79, 4.79},
    Published{dyn, "single_pendulum", "rp", 1, 1, 2.92, 2.91},
    Published{dyn, "single_pendulum", "rA", 2.43, 2.46, 2.88, 2.88},
    Published{dyn, "single_pendulum", "reps", 1.29, 1.69, 2.88, 2.88},
    Published{dyn, "double_pendulum", "rp", 1, 1, 2.99, 2.93},
    Published{dyn, "double_pendulum", "rA", 2.63, 2.39, 2.77, 2.77},
    Published{dyn, "double_pendulum", "reps", 1.21, 1.53, 2.77, 2.77},
    Published{dyn, "four_link", "rp", 1, 1, 3.09, 3.22},
    Published{dyn, "four_link", "rA", 2.62, 2.41, 3.01, 3.01},
    // C2 as released needs 12.89 iterations here: its second-order variant scales the residual wrongly.
    Published{dyn, "four_link", "reps", 1.21, 1.44, 3.20, 3.23},
    Published{dyn, "slider_crank", "rp", 1, 1, 2.16, 2.14},
    Published{dyn, "slider_crank", "rA", 2.93, 2.29, 2.31, 2.31},
    Published{dyn, "slider_crank", "reps", 1.31, 1.30, 2.49, 2.49},
};

constexpr std::array kIterations{OriginalIterations{"rA", 1e-2, 7.63},   OriginalIterations{"rA", 5e-3, 5.86},
                                 OriginalIterations{"rA", 2e-3, 4.43},   OriginalIterations{"rA", 1e-3, 3.75},
                                 OriginalIterations{"rp", 1e-2, 9.16},   OriginalIterations{"rp", 5e-3, 6.82},
                                 OriginalIterations{"rp", 2e-3, 5.04},   OriginalIterations{"rp", 1e-3, 4.24},
                                 OriginalIterations{"reps", 1e-2, 8.78}, OriginalIterations{"reps", 5e-3, 6.80},
                                 OriginalIterations{"reps", 2e-3, 4.97}, OriginalIterations{"reps", 1e-3, 4.18}};

}  // namespace

std::span<const PublishedCounts> published_counts() {
  return kCounts;
}

const Published* find_published(Analysis analysis, std::string_view mechanism, std::string_view formulation) {
  const auto it = std::find_if(kPublished.begin(), kPublished.end(), [&](const Published& p) {
    return p.analysis == analysis && p.mechanism == mechanism && p.formulation == formulation;
  });
  return it == kPublished.end() ? nullptr : &*it;
}

std::span<const OriginalIterations> original_iterations() {
  return kIterations;
}

}  // namespace poinsot::paper
