// The paper's tables from cells with known times, and the times of the original codes by processor: a ratio needs both
// from one processor.
#include "bench/paper/paper_tables.h"

#include <gmock/gmock.h>

#include "bench/paper/mechanisms.h"
#include "bench/paper/original_codes.h"
#include "bench/paper/phase_tables.h"
#include "bench/paper/published.h"
#include "formulations/registry.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using paper::advantage_table;
using paper::against_original_table;
using paper::iterations_table;
using paper::kMechanisms;
using paper::phases_table;
using paper::speed_up_table;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// A step of `us`, a quarter of it in each phase, in 2 iterations.
Statistics statistics(double us) {
  Statistics s;
  s.steps = 1000;
  s.newton_iterations = 2000;
  s.factorizations = 1000;
  s.seconds.total = us * 1e-3;
  s.seconds.assembly = s.seconds.factor = s.seconds.solve = s.seconds.other = us * 1e-3 / 4;
  return s;
}

// Of the whole product: rA takes 1 µs, rp 3, reps 2; three repetitions.
struct Cells {
  Cells() {
    for (const auto& mechanism : kMechanisms)
      for (const FormulationEntry& formulation : formulations()) {
        Settings settings;
        settings.formulation = formulation.name;
        settings.jacobian = "simplified";
        const double us = formulation.name == "rA" ? 1 : formulation.name == "rp" ? 3 : 2;
        cells.push_back({mechanism.file, nullptr, settings, {}, {}, false});
        for (const double factor : {1.1, 0.9, 1.0}) cells.back().runs.push_back(statistics(factor * us));
      }
  }
  std::vector<study::Cell> cells;
};

TEST(OriginalCodes, are_found_by_the_name_of_the_processor_alone) {
  for (const char* name : {"AMD EPYC", "AMD EPYC Processor", "AMD(R) EPYC(TM)", "amd epyc"}) {
    ASSERT_NE(paper::original_machine(name), nullptr) << name;
    EXPECT_EQ(paper::original_machine(name)->processor, "AMD EPYC") << name;
  }
  for (const char* name :
       {"Intel(R) Xeon(R) CPU @ 2.50GHz", "Intel Xeon 2.50 GHz", "Intel(R) Xeon(R) Processor @ 2.50GHz"}) {
    ASSERT_NE(paper::original_machine(name), nullptr) << name;
    EXPECT_EQ(paper::original_machine(name)->processor, "Intel Xeon 2.50 GHz") << name;
  }
  // Another model, another clock, no model at all.
  for (const char* name : {"AMD EPYC 7763 64-Core Processor", "AMD Ryzen 9", "Intel(R) Xeon(R) Processor",
                           "Intel(R) Xeon(R) CPU @ 2.20GHz", "EPYC", "unknown", ""})
    EXPECT_EQ(paper::original_machine(name), nullptr) << name;
}

TEST(OriginalCodes, were_timed_in_every_formulation_of_every_mechanism) {
  ASSERT_GE(paper::original_machines().size(), 2u);
  for (const auto& machine : paper::original_machines())
    for (const Analysis analysis : {Analysis::kinematics, Analysis::dynamics})
      for (const auto& mechanism : kMechanisms)
        for (const FormulationEntry& formulation : formulations()) {
          const auto* time = machine.find(analysis, mechanism.file, formulation.name);
          ASSERT_EQ(time != nullptr, analysis == Analysis::dynamics || mechanism.driven) << mechanism.file;
          if (!time) continue;
          EXPECT_GT(time->c1, 100) << machine.processor << mechanism.file;
          EXPECT_GT(time->fastest(), 100) << machine.processor << mechanism.file;
          EXPECT_LE(time->fastest(), time->c1) << machine.processor << mechanism.file;
        }
  const auto& xeon = *paper::original_machine("Intel Xeon 2.50 GHz");
  EXPECT_EQ(xeon.find(Analysis::dynamics, "four_link", "reps")->fastest(), 5796);  // order 1, not the released 17469
}

TEST(AgainstOriginal, gives_ratios_on_the_processor_of_the_codes) {
  const Cells all;
  const study::Table table = against_original_table(all.cells, Analysis::dynamics, "AMD EPYC");
  ASSERT_EQ(table.rows.size(), kMechanisms.size() * formulations().size());
  const auto row = [&](const std::string& mechanism, const std::string& formulation) {
    for (const auto& r : table.rows)
      if (r[0] == mechanism && r[1] == formulation) return r;
    return std::vector<std::string>();
  };
  EXPECT_THAT(row("Single pendulum", "rA"), ElementsAre("Single pendulum", "rA", "385", "1.000", "385"));
  EXPECT_THAT(row("Slider crank", "rp"), ElementsAre("Slider crank", "rp", "2151", "3.000", "717"));
  EXPECT_THAT(table.text, HasSubstr("Faster 292 to 1169 times with the simplified matrix"));
  EXPECT_THAT(table.text, HasSubstr("measured on a processor of the same name, AMD EPYC"));
}

TEST(AgainstOriginal, gives_none_on_another_processor_and_says_so) {
  const Cells all;
  const study::Table table = against_original_table(all.cells, Analysis::dynamics, "Some CPU 3");
  ASSERT_EQ(table.rows.size(), kMechanisms.size() * formulations().size());
  for (const auto& row : table.rows) {
    EXPECT_EQ(row[2], "-");
    EXPECT_NE(row[3], "-");
    EXPECT_EQ(row[4], "-");
  }
  EXPECT_THAT(table.text,
              HasSubstr("Of the processor at hand, Some CPU 3, there are no times of them, only of AMD EPYC "
                        "and Intel Xeon 2.50 GHz"));
  EXPECT_THAT(table.text, Not(HasSubstr("Faster")));
}

TEST(PaperTables, speed_ups_are_relative_to_rp) {
  const Cells all;
  const study::Table table = speed_up_table(all.cells, Analysis::dynamics);
  ASSERT_EQ(table.rows.size(), kMechanisms.size() * formulations().size());
  for (const auto& row : table.rows)
    EXPECT_EQ(row[2], row[1] == "rA" ? "3.00" : row[1] == "rp" ? "1.00" : "1.50") << row[0];
  EXPECT_THAT(table.text,
              HasSubstr("rA against rp: 3.00 to 3.00 with the simplified matrix here; 2.29 to 2.93 in the"));
  EXPECT_THAT(speed_up_table(all.cells, Analysis::kinematics).rows, ElementsAre());
}

TEST(PaperTables, iterations_and_phases_are_those_of_a_step) {
  const Cells all;
  for (const auto& row : iterations_table(all.cells, Analysis::dynamics).rows) EXPECT_EQ(row[2], "2.00");
  for (const auto& row : phases_table(all.cells, Analysis::dynamics).rows) {
    EXPECT_EQ(row[3], row[1] == "rA" ? "1.000" : row[1] == "rp" ? "3.000" : "2.000");
    EXPECT_EQ(row[4], "10.0");                                      // per cent between the quartiles
    EXPECT_EQ(std::stod(row[5]) * 4, std::stod(row[3])) << row[5];  // assembly
  }
  for (const auto& row : advantage_table(all.cells, Analysis::dynamics).rows)
    EXPECT_EQ(row[3], row[1] == "rp" ? "2.000" : "1.000");
}

TEST(PaperTables, a_cell_without_figures_leaves_dashes) {
  Cells all;
  for (study::Cell& cell : all.cells)
    if (cell.settings.formulation == "rp") cell.runs.clear();
  for (const auto& row : speed_up_table(all.cells, Analysis::dynamics).rows) EXPECT_EQ(row[2], "-");
}

TEST(PaperTables, ours_are_the_papers_constraints) {
  std::vector<Scene> scenes;
  for (const auto& mechanism : kMechanisms) scenes.push_back(scene_of(mechanism.file));
  for (const auto& row : paper::constraint_counts(scenes).rows)
    for (std::size_t k = 1; k <= 4; ++k) EXPECT_EQ(row[k], row[k + 4]) << row[0];
}

TEST(Published, has_what_the_paper_prints) {
  EXPECT_EQ(paper::find_published(Analysis::dynamics, "slider_crank", "rA")->speedup_c1, 2.93);
  EXPECT_EQ(paper::find_published(Analysis::kinematics, "double_pendulum", "rA"), nullptr);
  for (std::size_t m = 0; m < kMechanisms.size(); ++m)
    EXPECT_EQ(paper::published_counts()[m].mechanism, kMechanisms[m].file);
  EXPECT_EQ(paper::original_iterations().size(), 4 * formulations().size());
}

}  // namespace
}  // namespace poinsot::test
