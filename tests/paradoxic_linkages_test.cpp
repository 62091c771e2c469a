// Linkages that no count of rows lets move, and joints that stand twice: in every formulation and by every integrator
// they move, stay closed, keep their energy, and follow the same mechanism written without redundancy; rank is what
// their geometry says.
#include <gmock/gmock.h>

#include "bench/study/scene_check.h"
#include "tests/support/course.h"
#include "tests/support/every_way.h"
#include "tests/support/paradoxic_machines.h"

namespace poinsot::test {
namespace {

constexpr double kMachineStep = 2.5e-3, kMachineEnd = 0.5;

// How far the joints of a scene have come apart, in m and rad, by points and directions attached at its initial pose.
double open(const Scene& scene, const std::vector<BodyState>& now) {
  struct Place {
    Vector3 r;
    Matrix3 A;
  };
  const auto place = [&](int body) {
    return body == kGround ? Place{Vector3::Zero(), Matrix3::Identity()}
                           : Place{now[static_cast<std::size_t>(body)].r, now[static_cast<std::size_t>(body)].A};
  };
  const auto start = [&](int body) {
    return body == kGround ? Place{Vector3::Zero(), Matrix3::Identity()}
                           : Place{scene.bodies[static_cast<std::size_t>(body)].position,
                                   scene.bodies[static_cast<std::size_t>(body)].orientation};
  };
  double most = 0;
  for (const Joint& joint : scene.joints) {
    const Place i = place(joint.i), j = place(joint.j), i0 = start(joint.i), j0 = start(joint.j);
    const Matrix3 turn_i = i.A * i0.A.transpose(), turn_j = j.A * j0.A.transpose();
    const Vector3 span = j.r + turn_j * (joint.point - j0.r) - i.r - turn_i * (joint.point - i0.r),
                  axis = turn_i * joint.axis.normalized(), other = turn_j * joint.axis.normalized();
    double by = (axis - other).norm();
    switch (joint.type) {
      case JointType::revolute:
        by = std::max(by, span.norm());
        break;
      case JointType::translational:
        by = std::max((turn_i - turn_j).norm(), span.cross(axis).norm());
        break;
      default:
        by = INFINITY;
    }
    most = by <= most ? most : std::isnan(by) ? INFINITY : by;
  }
  return most;
}

double kinetic(const Scene& scene, const Snapshot& at) {
  double sum = 0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyState& x = at.bodies[b];
    sum += 0.5 * scene.bodies[b].mass * x.rd.squaredNorm() + 0.5 * x.w.dot(scene.bodies[b].inertia * x.w);
  }
  return sum;
}

double energy(const Scene& scene, const Snapshot& at) {
  double sum = kinetic(scene, at);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) sum -= scene.bodies[b].mass * scene.gravity.dot(at.bodies[b].r);
  return sum;
}

// By how much the angle between the bodies of a joint has changed, rad, at the joint where it is most.
double bent(const Scene& scene, const std::vector<BodyState>& now) {
  const auto turn = [&](int body) -> Matrix3 {
    if (body == kGround) return Matrix3::Identity();
    const auto b = static_cast<std::size_t>(body);
    return now[b].A * scene.bodies[b].orientation.transpose();
  };
  double most = 0;
  for (const Joint& joint : scene.joints)
    most = std::max(most, Eigen::AngleAxisd(Matrix3(turn(joint.i).transpose() * turn(joint.j))).angle());
  return most;
}

double apart_in_pose(const std::vector<BodyState>& a, const std::vector<BodyState>& b) {
  double most = a.size() == b.size() ? 0 : INFINITY;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    for (const double d : {(a[k].r - b[k].r).norm(), (a[k].A - b[k].A).norm()})
      most = d <= most ? most : std::isnan(d) ? INFINITY : d;
  return most;
}

// Of the method, over this motion.
struct Accuracy {
  double pose, energy, open;
};

Accuracy accuracy_of(const IntegratorEntry& integrator) {
  if (integrator.controls_error) return {1e-6, 1e-6, 1e-9};
  return integrator.order == 1 ? Accuracy{0.3, 0.2, 1e-8} : Accuracy{2e-3, 1e-3, 1e-8};
}

class ParadoxicLinkages : public ::testing::TestWithParam<ParadoxicMachine> {};

TEST_P(ParadoxicLinkages, MoveStayClosedKeepEnergyAndFollowTheMechanismWithoutRedundancy) {
  int ways = 0, same = 0;
  for (const bool carried : {false, true}) {
    // The reference has neither redundancy nor the frames, nor the formulation of what is compared with it.
    const Scene plain = GetParam().make({Frames::drawn, carried, false});
    for (const FormulationEntry& formulation : formulations()) {
      const Settings tight =
          controlled("dop853", formulation.name == "rA" ? "rp" : "rA", 1e-11, kMachineEnd, kMachineEnd);
      const Course reference = move(plain, tight);
      ASSERT_TRUE(reference.outcome.status.ok()) << reference.outcome.status.message;
      ASSERT_THAT(reference.outcome.notices, ::testing::Not(::testing::Contains(::testing::HasSubstr("redundant"))));
      for (const IntegratorEntry& integrator : integrators()) {
        if (integrator.analysis != Analysis::dynamics || refusal_of(integrator, formulation.name)) continue;
        const Frames frames = ways % 3 == 0 ? Frames::quarter_turns : ways % 3 == 1 ? Frames::random : Frames::drawn;
        ++ways;
        SCOPED_TRACE(fmt::format("{} {} frames {}{}", integrator.name, formulation.name, static_cast<int>(frames),
                                 carried ? ", carried" : ""));
        const Scene scene = GetParam().make({frames, carried, true});
        Settings settings = dynamics(formulation.name, kMachineStep, kMachineEnd, kMachineEnd / 4);
        settings.integrator = integrator.name;
        settings.tolerance = 1e-7;
        settings.rtol = 1e-9;
        const Course course = move(scene, settings);
        ASSERT_TRUE(course.outcome.status.ok()) << course.outcome.status.message;
        ASSERT_EQ(course.samples.size(), 5u);
        const Accuracy accuracy = accuracy_of(integrator);
        double largest = 0;
        for (const Snapshot& sample : course.samples) {
          EXPECT_LT(open(scene, sample.bodies), accuracy.open) << sample.t;
          largest = std::max(largest, kinetic(scene, sample));
        }
        EXPECT_GT(bent(scene, course.end()), 0.2);
        EXPECT_LT(std::abs(energy(scene, course.samples.back()) - energy(scene, course.samples.front())),
                  accuracy.energy * largest);
        std::vector<BodyState> end = course.end();  // turned into the reference's frames
        for (std::size_t b = 0; b < end.size(); ++b)
          end[b].A = end[b].A * scene.bodies[b].orientation.transpose() * plain.bodies[b].orientation;
        EXPECT_LT(apart_in_pose(end, reference.end()), accuracy.pose);
        // Fixed steps that do not begin anew where rows are exchanged solve the same equations.
        if (integrator.controls_error || integrator.name.starts_with("generalized_alpha")) continue;
        const Course without = move(GetParam().make({frames, carried, false}), settings);
        ASSERT_TRUE(without.outcome.status.ok()) << without.outcome.status.message;
        EXPECT_EQ(course.outcome.statistics.divided_steps, 0);
        if (without.outcome.statistics.divided_steps > 0) continue;  // other equations
        EXPECT_LT(apart_in_pose(course.end(), without.end()), 1e-7);
        ++same;
      }
    }
  }
  EXPECT_GE(ways, 50);
  EXPECT_GE(same, 17);  // of 18
}

TEST_P(ParadoxicLinkages, AreDrivenAsWithoutRedundancy) {
  if (GetParam().freedoms > 1) return;
  const auto driven = [](Frames frames, bool redundant) {
    Scene scene = GetParam().make({frames, false, redundant});
    Driver& motor = scene.drivers.emplace_back();
    motor.name = "motor";
    motor.i = scene.joints[0].i, motor.j = scene.joints[0].j;
    motor.axis = scene.joints[0].axis;  // of the ground
    motor.value = Expression::parse("0.35*sin(2*t)");
    return scene;
  };
  for (const FormulationEntry& formulation : formulations()) {
    for (const Frames frames : {Frames::drawn, Frames::quarter_turns, Frames::random}) {
      SCOPED_TRACE(fmt::format("{} frames {}", formulation.name, static_cast<int>(frames)));
      const Scene scene = driven(frames, true);
      const Settings settings = kinematics(formulation.name, 0.05, 1.5, 0.25);
      const std::vector<Snapshot> with = motion(scene, settings), without = motion(driven(frames, false), settings);
      ASSERT_EQ(with.size(), 7u);
      for (const Snapshot& sample : with) EXPECT_LT(open(scene, sample.bodies), 1e-10) << sample.t;
      EXPECT_GT(bent(scene, with[3].bodies), 0.3);
      EXPECT_LT(distance(with, without).largest(), 1e-8) << distance(with, without);
    }
  }
}

TEST_P(ParadoxicLinkages, AreCheckedForWhatTheirGeometrySays) {
  for (const Frames frames : {Frames::drawn, Frames::quarter_turns, Frames::random}) {
    for (const bool carried : {false, true}) {
      for (const bool redundant : {true, false}) {
        SCOPED_TRACE(fmt::format("frames {}{}{}", static_cast<int>(frames), carried ? ", carried" : "",
                                 redundant ? ", redundant" : ""));
        const study::SceneCheck found = study::check_scene(GetParam().make({frames, carried, redundant}));
        EXPECT_TRUE(found.sound()) << found.refusal;
        EXPECT_EQ(found.rank.degrees_of_freedom(), GetParam().freedoms + (carried ? 6 : 0));
        EXPECT_EQ(found.rank.dependent.size(), static_cast<std::size_t>(redundant ? GetParam().redundant : 0));
        EXPECT_EQ(found.rank.aside.size(), found.rank.dependent.size());
        EXPECT_FALSE(found.rank.singular_position());
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ParadoxicLinkages, ::testing::ValuesIn(kParadoxicMachines),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace poinsot::test
