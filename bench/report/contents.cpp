#include "bench/report/contents.h"

#include <array>

namespace poinsot::report {
namespace {

constexpr std::array kPaper{
    Item{"Table 7",
         "Constraints of the mechanisms",
         "",
         {"constraint_counts"},
         "tables",
         "Counted in the compiled models, beside the paper's counts."},
    Item{"Table 8",
         "Kinematics: speed-up",
         "",
         {"kinematics_speed_up"},
         "tables",
         "Like for like is the simplified matrix, which the paper's two codes use."},
    Item{"Table 9",
         "Kinematics: iterations to convergence",
         "",
         {"kinematics_iterations"},
         "tables",
         "Average over the steps, position analysis."},
    Item{"Table 10",
         "Dynamics: speed-up",
         "",
         {"dynamics_speed_up"},
         "tables",
         "Like for like is the simplified matrix, which the paper's two codes use."},
    Item{"Figures 2 and 4",
         "Iterations over the step size, four link",
         "iterations",
         {"iterations_table", "iterations_original"},
         "figures iterations",
         "The paper shows kinematics and dynamics; beside ours the iterations of its codes."},
    Item{"Figure 3",
         "Double pendulum: differences of the solutions",
         "solution_deltas",
         {"solution_deltas_table"},
         "figures solution_deltas",
         "The height of the second pendulum against an accurate solution, and against rA's."},
    Item{"Figures 5 to 7",
         "Order of implicit Euler in the paper's coordinates",
         "order_paper",
         {"order_paper_table"},
         "figures order_paper",
         "Drivers prescribe the positions, so that these errors do not depend on the equations of motion."}};

constexpr std::array kCost{
    Item{"",
         "Dynamics: where the time of a step goes",
         "",
         {"dynamics_phases", "dynamics_advantage"},
         "tables",
         "Medians, microseconds; the spread is the distance of the quartiles."},
    Item{"", "Kinematics: where the time of a step goes", "", {"kinematics_phases", "kinematics_advantage"}, "tables"},
    Item{"", "Dynamics: iterations of Newton's method", "", {"dynamics_iterations"}, "tables"},
    Item{"",
         "Beside the original Python codes",
         "",
         {"dynamics_against_original", "kinematics_against_original"},
         "tables",
         "A time is divided by another one of the same processor only."}};

constexpr std::array kSolvers{
    Item{"",
         "All linear solvers",
         "",
         {"linear_solvers"},
         "tables",
         "Compare solvers on the same system: G, the constraint Jacobian alone, or the whole matrix."}};

constexpr std::array kFronts{Item{"",
                                  "For this accuracy on this kind of scene take this",
                                  "fronts_plot",
                                  {"fronts_choice", "fronts_integrators", "fronts_methods"},
                                  "chart --all --quick",
                                  "Over all charts; the picture shows the error in positions."}};

constexpr std::array kOrders{Item{"",
                                  "Orders of the integrators of fixed step",
                                  "order_integrators",
                                  {"order_integrators_table"},
                                  "figures order_integrators",
                                  "Multipliers show what the paper's analysis cannot."},
                             Item{"",
                                  "Orders of the integrators with error control, at equal steps",
                                  "order_controlled",
                                  {"order_controlled_table"},
                                  "figures order_controlled"}};

constexpr std::array kGrowth{Item{"",
                                  "Growth with the number of bodies",
                                  "scaling_plot",
                                  {"growth", "scaling"},
                                  "scale",
                                  "An exponent of one is linear growth, a flat curve per body."}};

constexpr std::array kEnergy{Item{
    "", "Energy over long runs", "energy", {"energy_table"}, "figures energy", "Bounded is what stays in its band."}};

constexpr std::array kStability{Item{"",
                                     "Where methods fail",
                                     "amplification",
                                     {"stability_use", "stability_verdicts", "stability_doubtful"},
                                     "stability",
                                     "Verdicts over families of scenes that lead to an edge; the spectral radius of a "
                                     "step of an oscillator, measured on the code."}};

constexpr std::array kContents{Section{"paper", "The paper's tables and figures", kPaper},
                               Section{"cost", "Phases of a step", kCost},
                               Section{"solvers", "Linear solvers", kSolvers},
                               Section{"precision", "Work and precision", kFronts},
                               Section{"orders", "Orders", kOrders},
                               Section{"growth", "Growth", kGrowth},
                               Section{"energy", "Energy", kEnergy},
                               Section{"stability", "Stability", kStability}};

}  // namespace

std::span<const Section> contents() {
  return kContents;
}

}  // namespace poinsot::report
