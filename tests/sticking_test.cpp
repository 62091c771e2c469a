// Laws of springs that jump, with a motion that comes to the jump and cannot leave it: dry friction once a body sticks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "integrators/settings_table.h"
#include "tests/support/every_way.h"
#include "tests/support/remedies.h"

namespace poinsot::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A body beside a place that the force of a law draws it to, against its weight.
Scene drawn(const char* law) {
  return parse_scene(fmt::format(R"json({{"scene": 1, "name": "drawn", "gravity": [0, 0, -1], "bodies": [
    {{"name": "body", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0.3]}}],
    "forces": [{{"type": "spring", "name": "string", "bodies": ["ground", "body"], "s_i": [0, 0, 0], "s_j": [0, 0, 0],
    "length": 0, "law": "{}"}}]}})json",
                                 law),
                     "test");
}

// A wheel at 3 rad/s and a slide at 1 m/s beside it, each with a law of its own.
Scene sliding(const char* on_wheel, const char* on_slide) {
  return parse_scene(fmt::format(R"json({{"scene": 1, "name": "sliding", "gravity": [0, 0, -9.81], "bodies": [
    {{"name": "wheel", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0], "angular_velocity": [0, 0, 3]}},
    {{"name": "slide", "mass": 2, "inertia": [1, 1, 1], "position": [1, 0, 0], "velocity": [1, 0, 0]}}],
    "joints": [{{"type": "revolute", "bodies": ["ground", "wheel"], "point": [0, 0, 0], "axis": [0, 0, 1]}},
    {{"type": "translational", "bodies": ["ground", "slide"], "point": [1, 0, 0], "axis": [1, 0, 0]}}],
    "forces": [{{"type": "torsion_spring", "name": "brake", "bodies": ["ground", "wheel"], "axis": [0, 0, 1],
    "law": "{}"}}, {{"type": "spring", "name": "rail", "bodies": ["ground", "slide"], "s_i": [-5, 0, 0],
    "s_j": [0, 0, 0], "length": 1, "law": "{}"}}]}})json",
                                 on_wheel, on_slide),
                     "test");
}

class Sticking : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, Sticking, ::testing::ValuesIn(formulation_names()),
                         [](const auto& test) { return test.param; });

// Calls visit(settings) for each integrator of dynamics that takes the formulation.
template <class Visit>
void by_each(const std::string& formulation, Visit&& visit) {
  for (const IntegratorEntry& integrator : integrators()) {
    if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, formulation)) continue;
    SCOPED_TRACE(integrator.name);
    Settings settings;
    settings.integrator = integrator.name, settings.formulation = formulation;
    settings.rtol = 1e-6, settings.step = 1e-3, settings.end = 2.5;
    visit(settings);
  }
}

struct StickingCase {
  const char *wheel, *slide;              // laws that stick
  const char *steep_wheel, *steep_slide;  // in their place
  const char* of;
  double from;  // before which it does not stick
};
const StickingCase kCases[] = {
    {"2*sign(v) + 0.1*v", "0", "2*min(max(v/0.01, -1), 1) + 0.1*v", "0", "force 'brake'", 1.35},
    {"0", "8*sign(v) + x", "0", "8*min(max(v/0.01, -1), 1) + x", "force 'rail'", 0.14},
    {"2*(step(v) - step(-v)) + 0.1*v", "v", "2*min(max(v/0.01, -1), 1) + 0.1*v", "v", "force 'brake'", 1.35},
};

TEST_P(Sticking, EndsTheRunAndSaysWhichLaw) {
  for (const StickingCase& c : kCases)
    by_each(GetParam(), [&](const Settings& settings) {
      SCOPED_TRACE(c.of);
      const Recorded r = run(sliding(c.wheel, c.slide), settings);
      if (!r.outcome.status.ok()) {  // explicit forces go to and fro, by no more than a step makes of them
        expect_stopped(r, r.outcome.status.failure, c.of, "in the place of sign(v)");
        EXPECT_THAT(r.outcome.status.message, HasSubstr("v passes 0"));
        EXPECT_THAT(r.outcome.status.message, Not(HasSubstr("; try ")));
        EXPECT_THAT(r.outcome.status.message, Not(HasSubstr("singular position")));
        EXPECT_GT(r.outcome.status.time, c.from);
      }
      expect_helped(sliding(c.steep_wheel, c.steep_slide), settings);
    });
}

// A belt that sets out, a place that a law leads to: the jump itself moves on.
TEST_P(Sticking, ToWhatMovesEndsTheRunAndSaysWhichLaw) {
  const std::array laws{std::pair{"8*sign(v - 0.5*t)", 0.222}, std::pair{"8*sign(v + 2*(x - 5))", 0.309}};
  for (const auto& [law, from] : laws)
    by_each(GetParam(), [&, law = law, from = from](const Settings& settings) {
      SCOPED_TRACE(law);
      const Recorded r = run(sliding("0", law), settings);
      if (r.outcome.status.ok()) {
        EXPECT_FALSE(chooses_steps(settings));
        return;
      }
      expect_stopped(r, r.outcome.status.failure, "force 'rail'", "in the place of sign(v)");
      EXPECT_NEAR(r.outcome.status.time, from, 0.02);
    });
}

// A body that damping brings to rest on a jump by x: it goes to and fro ever faster.
TEST_P(Sticking, OnAPlaceEndsTheRunAndSaysWhichLaw) {
  by_each(GetParam(), [&](Settings settings) {
    settings.end = 10;
    const Recorded r = run(sliding("0", "100*sign(x - 5) + 40*v"), settings);
    if (r.outcome.status.ok()) {
      EXPECT_FALSE(chooses_steps(settings));
    } else {
      expect_stopped(r, r.outcome.status.failure, "force 'rail'", "in the place of sign(x)");
      EXPECT_THAT(r.outcome.status.message, HasSubstr("N where x passes 5,"));
      EXPECT_THAT(r.outcome.status.message, Not(HasSubstr("; try ")));
      EXPECT_THAT(r.outcome.status.message, Not(HasSubstr("singular position")));
      EXPECT_GT(r.outcome.status.time, 0.1);
    }
    settings.end = 2.5;
    expect_helped(sliding("0", "100*min(max((x - 5)/0.01, -1), 1) + 40*v"), settings);
  });
}

// Likewise on the place where a spring that still pulls has no length.
TEST_P(Sticking, WithoutLengthEndsTheRunAndSaysWhichSpring) {
  by_each(GetParam(), [&](Settings settings) {
    settings.end = 10;
    const Recorded r = run(drawn("100 + 20*v"), settings);
    if (r.outcome.status.ok()) {
      EXPECT_FALSE(chooses_steps(settings));
    } else {
      expect_stopped(r, r.outcome.status.failure, "force 'string'", "where the spring has no length");
      EXPECT_THAT(r.outcome.status.message, HasSubstr("min((x + length)/c, 1)"));
      EXPECT_THAT(r.outcome.status.message, Not(HasSubstr("; try ")));
      EXPECT_GT(r.outcome.status.time, 0.2);
    }
    settings.end = 1;
    expect_helped(drawn("(100 + 20*v)*min(x/0.001, 1)"), settings);
  });
}

// A jump that a motion passes is none to stick to: of a place, and of a velocity where a spring is stronger.
TEST_P(Sticking, IsNotWhatPassesAJump) {
  by_each(GetParam(), [&](const Settings& settings) {
    expect_helped(sliding("0.2*sign(x - 1)", "0"), settings);
    expect_helped(sliding("0", "3*sign(v) + x"), settings);
  });
}

}  // namespace
}  // namespace poinsot::test
