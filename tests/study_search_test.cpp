// Fronts, sweeps and the search for the cheapest way to an accuracy: by what they say of errors, never by how fast
// anything is.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "bench/study/advice.h"
#include "bench/study/calibration.h"
#include "bench/study/chart.h"
#include "bench/study/sweep.h"
#include "core/scene_reader.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using study::front;
using study::Measured;
using testing::ElementsAre;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(Front, holds_what_nothing_beats) {
  EXPECT_THAT(front({1e-3, 1e-4, 1e-5}, {1, 2, 3}, 1e-12), ElementsAre(true, true, true));
  EXPECT_THAT(front({1e-3, 1e-4, 1e-3}, {1, 2, 2}, 1e-12), ElementsAre(true, true, false));
  EXPECT_THAT(front({1e-4, 1e-4}, {1, 2}, 1e-12), ElementsAre(true, false));  // as accurate, slower
  EXPECT_THAT(front({1e-4, 1e-5}, {1, 1}, 1e-12), ElementsAre(false, true));  // as fast, less accurate
  EXPECT_THAT(front({1e-4, 1e-4}, {1, 1}, 1e-12), ElementsAre(true, true));   // alike
  EXPECT_THAT(front({}, {}, 1e-12), ElementsAre());
}

TEST(Front, errors_the_reference_cannot_tell_apart_are_equal) {
  const double agreement = 1e-8;  // ten times that: 1e-7
  EXPECT_THAT(front({9e-8, 1e-9}, {1, 2}, agreement), ElementsAre(true, false));
  EXPECT_THAT(front({2e-7, 1e-9}, {1, 2}, agreement), ElementsAre(true, true));
}

TEST(Front, what_is_useless_or_no_number_is_on_none) {
  EXPECT_THAT(front({0.011, 0.01, kNone}, {1, 2, 3}, 1e-12), ElementsAre(false, true, false));
  EXPECT_THAT(front({kNone, 1e-3}, {kNone, 2}, 1e-12), ElementsAre(false, true));
}

TEST(Front, of_measured_cases_leaves_failures_out) {
  study::Reference reference;
  reference.agreement = {1e-12, 1e-12, 1e-5, kNone};
  std::vector<Measured> measured(3);
  measured[0].error = {1e-4, 1e-3, 8e-5, kNone};
  measured[0].seconds = 2;
  measured[1].error = {1e-3, 1e-4, 1e-6, kNone};
  measured[1].seconds = 3;
  measured[2].error = {1e-9, 1e-9, 1e-9, 1e-9};
  measured[2].seconds = 1e-3;
  measured[2].status = "no convergence";
  EXPECT_THAT(front(measured, 0, reference), ElementsAre(true, false, false));
  EXPECT_THAT(front(measured, 1, reference), ElementsAre(true, true, false));
  EXPECT_THAT(front(measured, 2, reference), ElementsAre(true, false, false));  // both below 1e-4
  EXPECT_THAT(front(measured, 3, reference), ElementsAre(false, false, false));
}

// A reference is computed once for all of them.
class Search : public testing::Test {
 protected:
  static constexpr double kEnd = 0.5;

  static void SetUpTestSuite() {
    std::vector<std::string> notices;
    scene_ = new Scene(scene_of("double_pendulum"));
    reference_ =
        new study::Reference(study::reference(*scene_, {kEnd, kEnd / study::kOutputs, 9}, study::Cache(""), notices));
    EXPECT_TRUE(notices.empty());
    ASSERT_GE(reference_->given, 0) << study::why_none(*reference_);
  }
  static void TearDownTestSuite() {
    delete reference_;
    delete scene_;
  }

  inline static Scene* scene_ = nullptr;
  inline static study::Reference* reference_ = nullptr;
};

TEST_F(Search, the_reference_resolves_what_it_was_asked_for) {
  EXPECT_GE(reference_->nearest, 0);
  EXPECT_NE(reference_->nearest, reference_->given);
  for (const double d : reference_->agreement) EXPECT_LT(d, 1e-8);
  EXPECT_EQ(reference_->motion.t.size(), study::kOutputs + 1u);
  EXPECT_NEAR(study::digits(1e-5), 5, 1e-12);
  EXPECT_NEAR(study::digits(0), 15.65, 0.01);
  EXPECT_EQ(study::digits(3), 0);
}

TEST_F(Search, a_plan_without_names_is_of_all_there_are) {
  for (const study::SweepPlan& plan : {study::SweepPlan::full(), study::SweepPlan::quick()}) {
    EXPECT_EQ(plan.formulations, formulations().names());
    std::vector<std::string> methods;
    for (const IntegratorEntry& integrator : integrators())
      if (!integrator.picks) methods.emplace_back(integrator.name);
    EXPECT_EQ(plan.integrators, methods);
    EXPECT_THAT(plan.linear_solvers, ElementsAre(study::kUsualSolver));
    for (const int steps : plan.steps) EXPECT_EQ(steps % study::kOutputs, 0);
    EXPECT_NO_THROW(require_cases(plan));
  }
}

TEST_F(Search, a_sweep_goes_through_every_case_that_fits) {
  study::SweepPlan plan = study::SweepPlan::quick();
  plan.steps = {100, 200};
  plan.tolerances = {1e-3, 1e-4, 1e-5};
  const auto levels = study::Sweep(*scene_, kEnd, *reference_).cases(plan);
  ASSERT_EQ(levels.size(), 3u);
  std::size_t by_step = 0, by_tolerance = 0;
  for (const IntegratorEntry& integrator : integrators())
    for (const FormulationEntry& formulation : formulations())
      if (!integrator.picks && !refusal_of(integrator, formulation.name))
        ++(integrator.controls_error ? by_tolerance : by_step);
  EXPECT_LT(by_step + by_tolerance, integrators().size() * formulations().size());  // some do not fit
  EXPECT_EQ(levels[0].size(), by_step + by_tolerance);
  EXPECT_EQ(levels[1].size(), by_step + by_tolerance);
  EXPECT_EQ(levels[2].size(), by_tolerance);
  for (const study::Case& one : levels[1]) {
    EXPECT_EQ(one.level, 1);
    EXPECT_EQ(one.value(), one.parameter() == "rtol" ? 1e-4 : kEnd / 200);
    EXPECT_EQ(one.settings.end, kEnd);
    EXPECT_EQ(one.settings.every, kEnd / study::kOutputs);
  }
}

TEST_F(Search, a_plan_of_what_does_not_fit_is_refused) {
  study::SweepPlan plan = study::SweepPlan::quick();
  bool some = false;
  for (const IntegratorEntry& integrator : integrators())
    for (const FormulationEntry& formulation : formulations()) {
      const auto refusal = refusal_of(integrator, formulation.name);
      if (!refusal) continue;
      some = true;
      plan.integrators = {std::string(integrator.name)};
      plan.formulations = {std::string(formulation.name)};
      try {
        require_cases(plan);
        ADD_FAILURE() << integrator.name << " in " << formulation.name;
      } catch (const InputError& refused) {
        EXPECT_EQ(refused.what(), fmt::format("integrator '{}' refuses formulation '{}': {}", integrator.name,
                                              formulation.name, refusal->why));
      }
    }
  EXPECT_TRUE(some);
}

TEST_F(Search, measures_errors_that_fall_with_the_tolerance) {
  study::SweepPlan plan = study::SweepPlan::quick();
  plan.formulations = {"rA", "rp"};
  plan.integrators = {"dop853", "implicit_euler"};
  plan.steps = {100, 400};
  plan.tolerances = {1e-3, 1e-7};
  const study::Sweep sweep(*scene_, kEnd, *reference_);
  std::vector<std::vector<Measured>> measured;
  int runs = 0;
  for (const auto& level : sweep.cases(plan)) measured.push_back(sweep.measure(level, 2, [&](const auto&) { ++runs; }));
  EXPECT_EQ(runs, 2 * 4 * (1 + 2));
  for (std::size_t k = 0; k < 4; ++k) {
    ASSERT_TRUE(measured[0][k].ok()) << measured[0][k].status;
    const double falls = k < 2 ? 1e-2 : 0.3;  // over four decades of rtol; of first order, a quarter
    for (std::size_t quantity = 0; quantity < 3; ++quantity)
      EXPECT_LT(measured[1][k].error[quantity], falls * measured[0][k].error[quantity]) << k << ' ' << quantity;
    EXPECT_GT(measured[0][k].seconds, 0);
    EXPECT_GT(measured[0][k].steps, 0);
  }
  EXPECT_EQ(measured[0][2].steps, 100);
  EXPECT_EQ(measured[1][2].steps, 400);
}

TEST_F(Search, a_failure_keeps_its_reason) {
  const study::Sweep sweep(*scene_, kEnd, *reference_);
  study::Case one = sweep.make_case("rA", integrators().require("implicit_euler"), 100, 0);
  one.settings.max_iterations = 1;
  one.settings.tolerance = 1e-14;
  const std::vector<Measured> measured = sweep.measure({one}, 3);
  EXPECT_FALSE(measured[0].ok());
  EXPECT_NE(measured[0].status, "");
}

TEST_F(Search, what_it_finds_is_as_accurate_as_asked_and_no_method_is_forgotten) {
  const study::Asked asked{1e-4, {0, 1}};
  const study::Sweep sweep(*scene_, kEnd, *reference_);
  const study::Calibration found = calibrate(sweep, *reference_, asked, false);
  ASSERT_FALSE(found.reaching.empty());
  std::set<std::string> methods;
  for (const study::Candidate& c : found.reaching) {
    EXPECT_TRUE(c.measured.ok()) << c.measured.status;
    EXPECT_LE(error(c.measured, *reference_, asked), asked.accuracy) << c.one.method();
    EXPECT_LE(std::max(c.measured.error[0], c.measured.error[1]), asked.accuracy) << c.one.method();
    EXPECT_TRUE(methods.insert(c.one.settings.integrator + c.one.settings.formulation).second);
    // Again, from the settings alone.
    EXPECT_EQ(sweep.compare(c.one).error[0], c.measured.error[0]) << c.one.method();
  }
  for (const study::Candidate& c : found.others) {
    EXPECT_GT(error(c.measured, *reference_, asked), asked.accuracy) << c.one.method();
    EXPECT_TRUE(methods.insert(c.one.settings.integrator + c.one.settings.formulation).second);
  }
  std::size_t all = 0;
  for (const IntegratorEntry& integrator : integrators())
    for (const FormulationEntry& formulation : formulations())
      all +=
          !integrator.picks && integrator.analysis == Analysis::dynamics && !refusal_of(integrator, formulation.name);
  EXPECT_EQ(methods.size(), all);
}

TEST_F(Search, what_cannot_be_told_is_no_success) {
  study::Reference blurred = *reference_;
  blurred.agreement.fill(1e-3);
  const study::Asked asked{1e-4, {0}};
  Measured measured;
  EXPECT_EQ(error(measured, blurred, asked), 1e-3);
  EXPECT_EQ(error(measured, *reference_, asked), reference_->agreement[0]);
  measured.error[0] = 0.25;
  EXPECT_EQ(error(measured, blurred, asked), 0.25);
  measured.error[0] = kNone;
  EXPECT_EQ(error(measured, *reference_, asked), std::numeric_limits<double>::infinity());
  measured.error[0] = 0;
  measured.status = "failed";
  EXPECT_EQ(error(measured, *reference_, asked), std::numeric_limits<double>::infinity());
}

TEST_F(Search, a_chart_goes_on_where_it_stopped) {
  study::SweepPlan plan = study::SweepPlan::quick();
  plan.formulations = {"rA"};
  plan.integrators = {"dop853", "implicit_euler"};
  plan.steps = {100, 200};
  plan.tolerances = {1e-4, 1e-6};
  plan.longest = 10;
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("poinsot-chart-{}.csv", getpid());
  const std::vector<std::string> notes = chart_notes(*scene_, kEnd, *reference_, plan, -1);
  const auto chart = [&](bool fresh) {
    study::ChartFile kept(file, notes, fresh);
    double runs = 0, all = 0;
    measure_chart(*scene_, kEnd, *reference_, plan, kept, [&](const study::Progress& progress) {
      ++runs;
      all = progress.done / progress.all;
    });
    EXPECT_NEAR(all, runs > 0 ? 1 : 0, 1e-12);
    return std::pair(runs, kept.rows());
  };
  const auto [runs, rows] = chart(true);
  EXPECT_EQ(runs, 4 * (1 + plan.repetitions));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_TRUE(std::ranges::any_of(rows, [](const study::ChartRow& row) { return row.front[0]; }));

  const auto [none, same] = chart(false);
  EXPECT_EQ(none, 0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(same[k].measured.seconds, rows[k].measured.seconds);
    EXPECT_EQ(same[k].measured.error, rows[k].measured.error);
    EXPECT_EQ(same[k].front, rows[k].front);
  }

  // Cut off within its last row: that case alone is measured again.
  std::string text;
  {
    std::ifstream in(file);
    text.assign(std::istreambuf_iterator<char>(in), {});
  }
  std::ofstream(file) << text.substr(0, text.find("\n#", text.find("\nrA,")) - 3);
  const auto [again, repaired] = chart(false);
  EXPECT_EQ(again, 1 + plan.repetitions);
  ASSERT_EQ(repaired.size(), 4u);
  EXPECT_EQ(repaired[0].measured.seconds, rows[0].measured.seconds);
  EXPECT_EQ(repaired[3].measured.error, rows[3].measured.error);

  std::vector<std::string> otherwise = notes;
  otherwise.back() += "?";
  EXPECT_THROW(study::ChartFile(file, otherwise, false), InputError);
  std::filesystem::remove(file);
}

TEST(Advise, tells_the_cheapest_way_what_is_unresolved_and_what_is_wasted) {
  const Scene scene = parse_scene(R"json({
    "scene": 1, "name": "sledge", "gravity": [0, 0, -9.81],
    "bodies": [{"name": "sledge", "mass": 2, "inertia": [1, 1, 1], "position": [0, 0, 1], "velocity": [1, 0, 0]}],
    "joints": [{"type": "translational", "name": "rail", "bodies": ["ground", "sledge"], "point": [0, 0, 1],
                "axis": [1, 0, 0]}],
    "forces": [{"type": "force", "name": "push", "body": "sledge", "point": [0, 0, 0], "force": ["cos(3*t)", 0, 0]}]
  })json",
                                  "sledge");
  std::vector<std::string> notices;
  const study::Advice advice = study::advise(scene, 1, {1e-5, {0}}, study::Cache(""), notices);
  EXPECT_TRUE(advice.unresolved.empty());
  ASSERT_FALSE(advice.calibration.reaching.empty());
  EXPECT_LE(advice.calibration.reaching.front().measured.error[0], 1e-5);
  EXPECT_THAT(advice.waste, testing::ElementsAre(testing::HasSubstr("never turning: 'sledge'")));
}

}  // namespace
}  // namespace poinsot::test
