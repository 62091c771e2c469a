// Steps of fixed length that go over the gap between two branches of a mechanism with several degrees of freedom, where
// velocities of the other branch differ by no more than a fraction: found out by the orientation of gradients.
#include "integrators/stepping/gap_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene_reader.h"
#include "integrators/start/rank.h"
#include "integrators/stepping/branch_side.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

Scene over_a_gap(std::string_view what) {
  return read_scene(fmt::format("{}/tests/scenes/{}_over_a_gap.json", POINSOT_SOURCE_DIR, what));
}

// Largest part of the velocities that two last states are apart by.
double apart(const std::vector<BodyState>& x, const std::vector<BodyState>& y) {
  double off = 0, size = 0;
  for (std::size_t b = 0; b < x.size(); ++b) {
    off = std::max({off, (x[b].rd - y[b].rd).norm(), (x[b].w - y[b].w).norm()});
    size = std::max({size, y[b].rd.norm(), y[b].w.norm()});
  }
  return off / size;
}

TEST(GapWatch, StepsDoNotEndOnAnotherBranchInSilence) {
  int stopped = 0;
  for (const std::string_view what : {"five_bar", "free_loop"}) {
    const Scene scene = over_a_gap(what);
    const std::vector<BodyState> truth = motion(scene, controlled("dop853", "rA", 1e-9, 0.45)).back().bodies;
    for (const double end : {0.45, 1.8}) {
      for (const IntegratorEntry& integrator : integrators()) {
        if (integrator.controls_error || integrator.analysis != Analysis::dynamics) continue;
        for (const FormulationEntry& formulation : formulations()) {
          Settings settings;
          settings.integrator = integrator.name, settings.formulation = formulation.name;
          settings.step = 0.01, settings.end = end, settings.every = 0.45;
          const Recorded r = run(scene, settings);
          SCOPED_TRACE(fmt::format("{} to {} s: {} {}", what, settings.end, integrator.name, formulation.name));
          if (!r.outcome.status.ok()) {
            ++stopped;
            EXPECT_LE(r.outcome.status.time, 0.9);
            continue;
          }
          ASSERT_GT(r.samples.size(), 1u);
          EXPECT_LT(apart(r.samples[1].bodies, truth), 0.2);
        }
      }
    }
  }
  EXPECT_GT(stopped, 20);
}

// Where error control finds no way, either, it is not known which is right.
TEST(GapWatch, WhatErrorControlCannotSettleIsTold) {
  const Scene scene = over_a_gap("four_bar");
  int told = 0;
  for (const std::string_view integrator : {"rattle", "generalized_alpha", "generalized_alpha_i2"}) {
    Settings settings;
    settings.integrator = integrator, settings.step = 0.02, settings.end = 1;
    const Recorded r = run(scene, settings);
    SCOPED_TRACE(integrator);
    if (!r.outcome.status.ok()) continue;
    EXPECT_THAT(r.outcome.notices, Contains(HasSubstr("is not certain")));
    ++told;
  }
  EXPECT_GT(told, 0);
}

// How often it is reversed from one to the next.
int reversals(const Scene& scene, const FormulationEntry& formulation, const std::vector<Snapshot>& states) {
  const auto model = std::make_shared<const Model>(compile(scene));
  const RankAnalysis rank = analyze_rank(model, states.front().bodies, RankNames::none);
  const std::unique_ptr<Problem> problem = formulation.make(model, rank.aside);
  BranchSide side(*problem);
  std::vector<double> q(static_cast<std::size_t>(problem->nq())), v(static_cast<std::size_t>(problem->nv()));
  int reversed = 0;
  for (const Snapshot& at : states) {
    problem->from_bodies(at.bodies, q, v);
    problem->set_position(at.t, q);
    reversed += side.reversed(*problem, true);
  }
  return reversed;
}

TEST(BranchSide, IsKeptAlongMotions) {
  for (const std::string_view name : {"double_four_bar", "andrews", "jansen", "double_wishbone", "delta_robot",
                                      "stewart_platform", "peaucellier", "flyball_governor"}) {
    const Scene scene = scene_of(name);
    const double end = name == "andrews" ? 0.03 : 1;
    const std::vector<Snapshot> states = motion(scene, controlled("dop853", "rA", 1e-8, end, end / 50));
    // Euler angles and row choices come to others on the way; that is for who asks to say.
    for (const char* formulation : {"rA", "rp"})
      EXPECT_EQ(reversals(scene, formulations().require(formulation), states), 0) << name << ' ' << formulation;
  }
}

// A slider beside the point from which its distance is driven: the branches are the sides of the foot.
TEST(BranchSide, IsReversedOnTheOtherSide) {
  const Scene scene = parse_scene(R"j({"scene": 1, "bodies": [{"name": "b", "mass": 1, "inertia": [1, 1, 1],
      "position": [0.3, 0.5, 0]}],
      "joints": [{"type": "translational", "bodies": ["ground", "b"], "point": [0.3, 0.5, 0], "axis": [1, 0, 0]}],
      "drivers": [{"type": "distance", "bodies": ["ground", "b"], "s_i": [0, 0, 0], "s_j": [0, 0, 0],
      "length": "sqrt(0.34)"}]})j",
                                  "slider");
  Snapshot beside{0, {{.r = {0.3, 0.5, 0}, .A = Matrix3::Identity()}}, {}}, across = beside;
  across.bodies[0].r.x() = -0.3;
  for (const FormulationEntry& formulation : formulations())
    EXPECT_EQ(reversals(scene, formulation, {beside, beside, across, across, beside}), 2) << formulation.name;
}

}  // namespace
}  // namespace poinsot::test
