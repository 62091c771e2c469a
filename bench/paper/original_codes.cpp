#include "bench/paper/original_codes.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace poinsot::paper {
namespace {

constexpr auto kKin = Analysis::kinematics;
constexpr auto kDyn = Analysis::dynamics;

// C2 as released integrates single and double pendulum in rp and all of the four link but rA with BDF2.
constexpr std::array kXeon{
    OriginalTime{kKin, "single_pendulum", "rp", 3511, 2131, 0},
    OriginalTime{kKin, "single_pendulum", "rA", 1503, 935, 0},
    OriginalTime{kKin, "single_pendulum", "reps", 2047, 1139, 0},
    OriginalTime{kKin, "four_link", "rp", 10840, 5332, 0},
    OriginalTime{kKin, "four_link", "rA", 4167, 2495, 0},
    OriginalTime{kKin, "four_link", "reps", 6425, 3347, 0},
    OriginalTime{kKin, "slider_crank", "rp", 13904, 6900, 0},
    OriginalTime{kKin, "slider_crank", "rA", 4627, 3124, 0},
    OriginalTime{kKin, "slider_crank", "reps", 6644, 4000, 0},
    OriginalTime{kDyn, "single_pendulum", "rp", 3667, 2453, 3063},
    OriginalTime{kDyn, "single_pendulum", "rA", 1418, 1105, 1105},
    OriginalTime{kDyn, "single_pendulum", "reps", 2391, 1499, 1499},
    OriginalTime{kDyn, "double_pendulum", "rp", 6596, 4157, 4727},
    OriginalTime{kDyn, "double_pendulum", "rA", 2336, 1711, 1711},
    OriginalTime{kDyn, "double_pendulum", "reps", 4558, 2650, 2650},
    OriginalTime{kDyn, "four_link", "rp", 12508, 6945, 8538},
    OriginalTime{kDyn, "four_link", "rA", 4524, 3078, 3253},
    OriginalTime{kDyn, "four_link", "reps", 9133, 17469, 5796},
    OriginalTime{kDyn, "slider_crank", "rp", 13490, 7465, 7465},
    OriginalTime{kDyn, "slider_crank", "rA", 4920, 3144, 3144},
    OriginalTime{kDyn, "slider_crank", "reps", 10536, 5339, 5339},
};

// C2 held to order 1 throughout: kinematics has no order.
constexpr std::array kEpyc{
    OriginalTime{kKin, "single_pendulum", "rA", 465, 327, 0},
    OriginalTime{kKin, "single_pendulum", "rp", 1243, 698, 0},
    OriginalTime{kKin, "single_pendulum", "reps", 597, 431, 0},
    OriginalTime{kKin, "four_link", "rA", 1519, 1071, 0},
    OriginalTime{kKin, "four_link", "rp", 4107, 2063, 0},
    OriginalTime{kKin, "four_link", "reps", 2204, 1413, 0},
    OriginalTime{kKin, "slider_crank", "rA", 1830, 1268, 0},
    OriginalTime{kKin, "slider_crank", "rp", 5725, 2625, 0},
    OriginalTime{kKin, "slider_crank", "reps", 2583, 1670, 0},
    OriginalTime{kDyn, "single_pendulum", "rA", 502, 0, 385},
    OriginalTime{kDyn, "single_pendulum", "rp", 1402, 0, 915},
    OriginalTime{kDyn, "single_pendulum", "reps", 845, 0, 584},
    OriginalTime{kDyn, "double_pendulum", "rA", 827, 0, 613},
    OriginalTime{kDyn, "double_pendulum", "rp", 2625, 0, 1443},
    OriginalTime{kDyn, "double_pendulum", "reps", 1603, 0, 1010},
    OriginalTime{kDyn, "four_link", "rA", 1551, 0, 1169},
    OriginalTime{kDyn, "four_link", "rp", 4625, 0, 2577},
    OriginalTime{kDyn, "four_link", "reps", 3177, 0, 1936},
    OriginalTime{kDyn, "slider_crank", "rA", 1445, 0, 1009},
    OriginalTime{kDyn, "slider_crank", "rp", 4724, 0, 2151},
    OriginalTime{kDyn, "slider_crank", "reps", 3174, 0, 1865},
};

constexpr OriginalMachine kMachines[] = {
    {"AMD EPYC",
     "2026-11-21, Python 3.11, numpy 1.24.2, scipy 1.10.1, one BLAS thread, CPU time, median of 3 repetitions of 1 s "
     "simulated at h = 1e-3, C2 held to order 1",
     kEpyc},
    {"Intel Xeon 2.50 GHz",
     "Python 3.11.2, numpy 1.24.2, scipy 1.10.1, one BLAS thread, CPU time, median of 3 interleaved repetitions of 1 s "
     "simulated at h = 1e-3 on a machine that others used as well",
     kXeon}};

// A processor's name without what may be written either way.
std::string plain(std::string_view name) {
  std::string text;
  for (const char c : name)
    if (c != ' ' && c != '@') text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const std::string_view word : {"(r)", "(tm)", "cpu", "processor"})
    for (std::size_t at = 0; (at = text.find(word)) != std::string::npos;) text.erase(at, word.size());
  return text;
}

}  // namespace

double OriginalTime::fastest() const {
  double least = c1;
  for (const double other : {c2, c2_order1})
    if (other > 0) least = std::min(least, other);
  return least;
}

const OriginalTime* OriginalMachine::find(Analysis analysis, std::string_view mechanism,
                                          std::string_view formulation) const {
  const auto it = std::find_if(times.begin(), times.end(), [&](const OriginalTime& time) {
    return time.analysis == analysis && time.mechanism == mechanism && time.formulation == formulation;
  });
  return it == times.end() ? nullptr : &*it;
}

std::span<const OriginalMachine> original_machines() {
  return kMachines;
}

const OriginalMachine* original_machine(std::string_view processor) {
  const auto it = std::ranges::find(kMachines, plain(processor),
                                    [](const OriginalMachine& machine) { return plain(machine.processor); });
  return it == std::end(kMachines) ? nullptr : &*it;
}

}  // namespace poinsot::paper
