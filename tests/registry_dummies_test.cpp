// What it takes to add a formulation, an integrator and a linear solver: this file, and nothing else.
//
// It is linked with the test suites of those that stand in the registries, as they were compiled for them. main() adds
// the three before the suites are made from the tables, so that they run over them as well.
#include <gmock/gmock.h>

#include <utility>

#include "core/input_error.h"
#include "formulations/derivative_checker.h"
#include "formulations/formulation_entry.h"
#include "formulations/rA.h"
#include "integrators/settings_reader.h"
#include "tests/support/derivative_tests.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;

// rA under a name of its own: what differs between formulations is that of any other.
struct DummyFormulation : RA {
  static constexpr std::string_view name = "dummy_formulation";
  static constexpr std::string_view about = "rA once more";
};
static_assert(Formulation<DummyFormulation>);
struct ChartsWithoutChange : RA {
  static constexpr CoordinateSpace space = CoordinateSpace::charts;
};
static_assert(!Formulation<ChartsWithoutChange>, "charts can be changed");
struct WithoutMass : RA {
  void mass() const;
};
static_assert(!Formulation<WithoutMass>, "a formulation has a mass matrix");

// Half-implicit Euler's steps under another name.
class DummyIntegrator final : public Integrator {
 public:
  Status run(const Run& run) override { return inner_->run(run); }

 private:
  std::unique_ptr<Integrator> inner_ = integrators().require("half_implicit").make();
};

// Leaves everything to dense, but for systems above a size of its own.
class DummyLinearSolver final : public LinearSolver {
 public:
  static constexpr int kLargest = 1000;

  std::span<const int> slots() const override { return inner_->slots(); }
  std::span<double> values() override { return inner_->values(); }
  const LinearStatistics& statistics() const override { return inner_->statistics(); }

 private:
  LinearStatus do_analyze(Pattern&& pattern) override {
    if (pattern.n > kLargest) return {LinearFailure::refused, -1, "dummy_linear_solver takes small systems only"};
    return inner_->analyze(std::move(pattern));
  }
  LinearStatus do_factor() override { return inner_->factor(); }
  LinearStatus do_solve(std::span<double> b) override { return inner_->solve(b); }

  std::unique_ptr<LinearSolver> inner_ = linear_solvers().require("dense").make();
};

void add_dummies() {
  formulations().add(formulation_entry<DummyFormulation>());
  IntegratorEntry integrator = integrators().require("half_implicit");
  integrator.name = "dummy_integrator";
  integrator.make = [] { return std::unique_ptr<Integrator>(std::make_unique<DummyIntegrator>()); };
  integrators().add(integrator);
  linear_solvers().add({"dummy_linear_solver", "dense once more",
                        [] { return std::unique_ptr<LinearSolver>(std::make_unique<DummyLinearSolver>()); }});
}

// Chosen as in a configuration file; the message of a wrong name lists all there are.
TEST(Dummies, AreListed) {
  for (const auto& [key, name] :
       {std::pair("formulation", "dummy_formulation"), std::pair("integrator", "dummy_integrator"),
        std::pair("linear_solver", "dummy_linear_solver")}) {
    Settings settings;
    set_setting(*find_setting(key), name, settings);
    EXPECT_EQ(value_text(*find_setting(key), settings), name);
    try {
      set_setting(*find_setting(key), "no_such_name", settings);
      ADD_FAILURE() << key << " takes any name";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(name));
    }
  }
  Settings settings;
  settings.formulation = "no_such_name";
  try {
    (void)simulate(scene_of("double_pendulum"), settings, {});
    ADD_FAILURE() << "simulate takes any name";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("dummy_formulation"));
  }
}

// All three in one run, to the last bit what those they are made of compute.
TEST(Dummies, RunTogether) {
  Settings settings;
  settings.formulation = "dummy_formulation";
  settings.integrator = "dummy_integrator";
  settings.linear_solver = "dummy_linear_solver";
  settings.end = 0.1;
  const Recorded found = run(scene_of("double_pendulum"), settings);
  ASSERT_TRUE(found.outcome.status.ok()) << found.outcome.status.message;
  ASSERT_EQ(found.outcome.statistics.linear.size(), 1);
  EXPECT_EQ(found.outcome.statistics.linear[0].solver, "dummy_linear_solver");
  settings.formulation = "rA";
  settings.integrator = "half_implicit";
  settings.linear_solver = "dense";
  const std::vector<Snapshot> expected = motion(scene_of("double_pendulum"), settings);
  ASSERT_EQ(found.samples.size(), expected.size());
  for (std::size_t n = 0; n < expected.size(); ++n) {
    for (std::size_t b = 0; b < expected[n].bodies.size(); ++b) {
      EXPECT_EQ(found.samples[n].bodies[b].r, expected[n].bodies[b].r);
      EXPECT_EQ(found.samples[n].bodies[b].A, expected[n].bodies[b].A);
    }
  }
}

// ida asks for a vector space of coordinates, whoever offers it.
TEST(Dummies, AreRefusedWhereTheyMustBe) {
  Settings settings;
  settings.formulation = "dummy_formulation";
  settings.integrator = "ida";
  try {
    (void)simulate(scene_of("double_pendulum"), settings, {});
    ADD_FAILURE() << "ida takes a formulation on a Lie group";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'ida' refuses formulation 'dummy_formulation'"));
  }

  const auto solver = linear_solvers().require("dummy_linear_solver").make();
  Pattern pattern;
  pattern.n = DummyLinearSolver::kLargest + 1;
  for (int k = 0; k < pattern.n; ++k) pattern.blocks.push_back({k, k, 1, 1}), pattern.node.push_back(k);
  EXPECT_EQ(solver->analyze(pattern).failure, LinearFailure::refused);
}

TEST(Dummies, HaveNamesOfTheirOwn) {
  EXPECT_THROW(formulations().add(formulation_entry<DummyFormulation>()), std::logic_error);
  EXPECT_THROW(integrators().add(integrators().require("dummy_integrator")), std::logic_error);
  EXPECT_THROW(linear_solvers().add(linear_solvers().require("dummy_linear_solver")), std::logic_error);
}

}  // namespace

INSTANTIATE_TYPED_TEST_SUITE_P(Dummies, Derivatives, ::testing::Types<DummyFormulation>, FormulationNames);

}  // namespace poinsot::test

int main(int argc, char** argv) {
  poinsot::test::add_dummies();
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
