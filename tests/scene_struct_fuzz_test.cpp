// Scenes built in C++ and damaged at random: each is refused with an InputError, comes to its end with finite numbers,
// or ends with a status that says why it did not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/input_error.h"
#include "core/scene_generator.h"
#include "tests/scale.h"
#include "tests/support/simulation.h"

namespace poinsot::test {
namespace {

class Damage {
 public:
  explicit Damage(std::mt19937_64& random) : random_(random) {}

  void to(Scene& scene) {
    for (std::size_t count = 1 + below(3); count > 0; --count) {
      switch (below(8)) {
        case 0:
          number(scene.gravity[axis()]);
          break;
        case 1:
        case 2:
          if (!scene.bodies.empty()) body(scene, pick(scene.bodies));
          break;
        case 3:
          if (!scene.constraints.empty()) constraint(scene, pick(scene.constraints));
          break;
        case 4:
        case 5:
          if (!scene.joints.empty()) joint(scene, pick(scene.joints));
          break;
        case 6:
          if (!scene.drivers.empty()) driver(scene, pick(scene.drivers));
          break;
        default:
          if (!scene.forces.empty()) std::visit([&](auto& f) { force(scene, f); }, pick(scene.forces));
      }
    }
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  Eigen::Index axis() { return static_cast<Eigen::Index>(below(3)); }
  template <class Item>
  Item& pick(std::vector<Item>& items) {
    return items[below(items.size())];
  }

  void number(double& x) {
    constexpr double kValues[] = {0,
                                  -0.0,
                                  1,
                                  -1,
                                  1e-320,
                                  1e-12,
                                  1e12,
                                  1e154,
                                  1e308,
                                  -1e308,
                                  std::numeric_limits<double>::infinity(),
                                  1e-16,
                                  1e-150,
                                  std::numeric_limits<double>::quiet_NaN()};
    x = below(3) == 0 ? x * (1 + 1e-3 * static_cast<double>(below(2000))) : kValues[below(std::size(kValues))];
  }
  void vector(Vector3& x) {
    if (below(4) == 0) {
      x.setZero();
    } else {
      number(x[axis()]);
    }
  }
  void function(Expression& f) {
    static const char* const kTexts[] = {"1/t", "log(t)",     "sqrt(-t)", "1e200*t",
                                         "t^9", "sin(1e9*t)", "0",        "exp(800*t)"};
    double constant = 1;
    number(constant);
    f = below(2) == 0 ? Expression(constant) : Expression::parse(kTexts[below(std::size(kTexts))]);
  }
  void index(const Scene& scene, int& body) {
    const int bodies = static_cast<int>(scene.bodies.size());
    const int values[] = {
        -2, -1, 0, bodies - 1, bodies, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()};
    body = values[below(std::size(values))];
  }
  void name(std::string& name) {
    static const char* const kNames[] = {"", "ground", "revolute1", "DP11", "a\tb", "\xc3", "Körper", "x"};
    name = kNames[below(std::size(kNames))];
  }
  template <class Type>
  void type(Type& type) {
    type = static_cast<Type>(static_cast<int>(below(8)) - 1);
  }
  template <class Item>
  bool common(const Scene& scene, Item& item) {  // what all that acts between two bodies has
    switch (below(6)) {
      case 0:
        name(item.name);
        return true;
      case 1:
        index(scene, item.i);
        return true;
      case 2:
        index(scene, item.j);
        return true;
      case 3:
        std::swap(item.i, item.j);
        return true;
      default:
        return false;
    }
  }

  void body(Scene& scene, Body& b) {
    switch (below(9)) {
      case 0:
        return name(b.name);
      case 1:
        return number(b.mass);
      case 2:
        return number(b.inertia(axis(), axis()));
      case 3:
        return vector(b.position);
      case 4:
        return number(b.orientation(axis(), axis()));
      case 5:
        return vector(b.velocity);
      case 6:
        return vector(b.angular_velocity);
      case 7:
        b.orientation *= 1 + 1e-6 * static_cast<double>(below(200));
        return;
      default:
        scene.bodies.pop_back();  // what refers to the last one is left behind
    }
  }
  void constraint(const Scene& scene, Constraint& c) {
    if (common(scene, c)) return;
    Vector3* const vectors[] = {&c.a_i, &c.a_j, &c.s_i, &c.s_j, &c.c};
    switch (below(4)) {
      case 0:
        return type(c.type);
      case 1:
        return function(c.f);
      case 2:
        c.alternate = Constraint::Alternate{c.a_i, c.a_j, c.f};
        return;
      default:
        vector(*vectors[below(5)]);
    }
  }
  void joint(const Scene& scene, Joint& j) {
    if (common(scene, j)) return;
    Vector3* const vectors[] = {&j.point, &j.axis, &j.axis_i, &j.axis_j};
    if (below(3) == 0) return type(j.type);
    vector(*vectors[below(4)]);
  }
  void driver(const Scene& scene, Driver& d) {
    if (common(scene, d)) return;
    Vector3* const vectors[] = {&d.axis, &d.s_i, &d.s_j};
    switch (below(3)) {
      case 0:
        return type(d.type);
      case 1:
        return function(d.value);
      default:
        vector(*vectors[below(3)]);
    }
  }
  void force(const Scene& scene, PointForce& f) { load(scene, f, f.force); }
  void force(const Scene& scene, Torque& f) { load(scene, f, f.torque); }
  template <class Load>
  void load(const Scene& scene, Load& f, Expression (&components)[3]) {
    if (below(3) == 0) return index(scene, f.body);
    if (below(3) == 0) return type(f.frame);
    function(components[below(3)]);
  }
  void force(const Scene& scene, Spring& f) {
    if (common(scene, f)) return;
    double* const numbers[] = {&f.stiffness, &f.damping, &f.length};
    if (below(2) == 0) return vector(f.s_i);
    number(*numbers[below(3)]);
  }
  void force(const Scene& scene, TorsionSpring& f) {
    if (common(scene, f)) return;
    double* const numbers[] = {&f.stiffness, &f.damping, &f.angle};
    if (below(2) == 0) return vector(f.axis);
    number(*numbers[below(3)]);
  }
  void force(const Scene& scene, LinearDrag& f) {
    if (below(2) == 0) return index(scene, f.body);
    number(below(2) == 0 ? f.translational : f.rotational);
  }
  void force(const Scene& scene, CallbackForce& f) { index(scene, f.bodies[below(f.bodies.size())]); }

  std::mt19937_64& random_;
};

TEST(SceneStructFuzz, damaged_scenes_are_refused_or_run_or_fail_by_name) {
  constexpr unsigned kSeed = 20240612;
  std::mt19937_64 random(kSeed);
  std::vector<Scene> scenes;
  for (const char* name :
       {"four_link", "slider_crank_joints", "steel_pendulum", "knife_edge", "heavy_top", "double_four_bar"}) {
    scenes.push_back(scene_of(name));
  }
  for (const SceneGenerator& generator : scene_generators()) scenes.push_back(generator.make(4));
  scenes.push_back(read_scene(POINSOT_SOURCE_DIR "/models/andrews.json"));

  int refused = 0, failed = 0, done = 0;
  for (int k = 0; k < scaled(1500); ++k) {
    Scene scene = scenes[static_cast<std::size_t>(k) % scenes.size()];
    Damage(random).to(scene);
    Settings settings;
    const char* const integrators[] = {"implicit_euler", "half_implicit", "rattle", "generalized_alpha", "dopri5"};
    const char* const formulations[] = {"rA", "rp", "reps"};
    settings.integrator = integrators[random() % std::size(integrators)];
    settings.formulation = formulations[random() % std::size(formulations)];
    settings.end = 3e-3;
    settings.rtol = 1e-4;
    const std::string where = fmt::format("seed {}, scene {} ({}), {} in {}", kSeed, k, scene.name, settings.integrator,
                                          settings.formulation);
    try {
      double sum = 0;
      const Outcome outcome = simulate(scene, settings, [&](const Sample& sample) {
        for (const auto& numbers : {sample.q, sample.v, sample.a, sample.lambda}) {
          for (const double x : numbers) sum += 0 * x;  // NaN where one of them is not finite
        }
      });
      EXPECT_EQ(sum, 0) << where << ": " << outcome.status.message;
      EXPECT_EQ(outcome.status.ok(), outcome.status.message.empty()) << where;
      ++(outcome.status.ok() ? done : failed);
    } catch (const InputError&) {
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << where << ": " << error.what();
    }
  }
  // All three ends are reached, or the damage tests nothing.
  EXPECT_GT(refused, scaled(1500) / 10);
  EXPECT_GT(failed, scaled(1500) / 100);
  EXPECT_GT(done, scaled(1500) / 10);
}

}  // namespace
}  // namespace poinsot::test
