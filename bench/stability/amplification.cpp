#include "bench/stability/amplification.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <memory>

#include "formulations/registry.h"
#include "integrators/equal_steps.h"
#include "integrators/methods/dop853.h"
#include "integrators/methods/dopri5.h"
#include "integrators/methods/generalized_alpha.h"
#include "integrators/methods/radau5.h"
#include "integrators/simulate.h"

namespace poinsot::stability {
namespace {

using Eigen::Matrix2d, Eigen::Matrix3d, Eigen::Vector2d;
using Complex = std::complex<double>;

const Vector3 kAxis(0.48, 0.6, 0.64);
constexpr double kAngle = 1e-6, kWay = 1e-6;  // rad, m: the unit
constexpr int kPropagations = 5;
constexpr double kDrawn = 1.5;  // a radius that is drawn

// Stiffness and inertia 1; starts at the unit state.
Scene scene_of(const Oscillator& oscillator, bool moving) {
  Scene scene;
  scene.name = oscillator.name();
  Body& body = scene.bodies.emplace_back();
  body.name = "body";
  body.mass = 1;
  body.inertia = Matrix3::Identity();
  if (oscillator.constrained) {
    Joint& joint = scene.joints.emplace_back();
    joint.type = oscillator.rotation ? JointType::revolute : JointType::translational;
    joint.j = 0;
    joint.axis = kAxis;
  }
  if (oscillator.rotation) {
    if (moving) body.angular_velocity = kAngle * kAxis;
    TorsionSpring spring;
    spring.j = 0;
    spring.axis = kAxis;
    spring.stiffness = 1;
    spring.damping = 2 * oscillator.damping;
    spring.angle = moving ? 0 : -kAngle;
    scene.forces.emplace_back(spring);
  } else {
    (moving ? body.velocity : body.position) = kWay * kAxis;
    Spring spring;
    spring.j = 0;
    spring.s_i = -kAxis;
    spring.stiffness = 1;
    spring.damping = 2 * oscillator.damping;
    spring.length = 1;
    scene.forces.emplace_back(spring);
  }
  return scene;
}

// y after each of the first steps, in units.
using Sequence = std::vector<Vector2d>;

class Reader {
 public:
  Reader(const Oscillator& oscillator, bool moving) : oscillator_(oscillator), moving_(moving) {}

  void operator()(const Sample& sample) {
    sample.problem.to_bodies(sample.a, bodies_);
    const BodyState& body = bodies_.front();
    if (oscillator_.rotation) {
      const Matrix3& A = body.A;
      const Vector3 twice_sine(A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1));
      y.emplace_back(std::asin(twice_sine.dot(kAxis) / 2) / kAngle + (moving_ ? 0 : 1), body.w.dot(kAxis) / kAngle);
    } else {
      y.emplace_back(body.r.dot(kAxis) / kWay, body.rd.dot(kAxis) / kWay);
    }
  }
  Sequence y;

 private:
  const Oscillator& oscillator_;
  bool moving_;
  std::vector<BodyState> bodies_ = std::vector<BodyState>(1);
};

// Empty: a step fails, or the integrator has none of its own.
Sequence sequence(const Oscillator& oscillator, bool moving, const IntegratorEntry& integrator, const Settings& s) {
  const Scene scene = scene_of(oscillator, moving);
  Reader read(oscillator, moving);
  const auto observe = [&](const Sample& sample) { read(sample); };
  if (!integrator.controls_error) return simulate(scene, s, observe).status.ok() ? read.y : Sequence{};
  // Steppers of error control; what they march through begins after the start.
  read.y.push_back(moving ? Vector2d(0, 1) : Vector2d(1, 0));
  const auto marched = [&](auto&& equal) {
    return equal.march(s.end, kPropagations, 1, observe).ok() ? read.y : Sequence{};
  };
  const auto pair = [&](const RungeKuttaPair& of) {
    return marched(EqualSteps<ExplicitStepper>(scene, s, [&](auto& problem, auto& systems, auto& work, auto& clock) {
      return std::make_unique<ExplicitStepper>(of, problem, systems, s.rtol, s.absolute_tolerance(), work, clock);
    }));
  };
  if (integrator.make == make_dopri5) return pair(dopri5_pair());
  if (integrator.make == make_dop853) return pair(dop853_pair());
  if (integrator.make == make_radau5)
    return marched(EqualSteps<RadauStepper>(scene, s, [&](auto& problem, auto& systems, auto& work, auto& clock) {
      return std::make_unique<RadauStepper>(problem, systems, s.rtol, s.absolute_tolerance(), work, clock);
    }));
  return {};
}

// The largest root, by its absolute value, of z² − trace z + determinant and of z³ + c₂ z² + c₁ z + c₀ (by the method
// of Weierstrass: all at once, from places on a spiral).
double radius(const Matrix2d& M) {
  const double half = M.trace() / 2, square = half * half - M.determinant();
  return square < 0 ? std::sqrt(M.determinant()) : std::abs(half) + std::sqrt(square);
}
double radius(const Eigen::Vector3d& c) {
  constexpr int kMostRounds = 500;
  const Complex seed(0.4, 0.9);
  std::array<Complex, 3> z{1.0, seed, seed * seed};
  for (int round = 0; round < kMostRounds; ++round) {
    double moved = 0;
    for (std::size_t k = 0; k < z.size(); ++k) {
      const Complex others = (z[k] - z[(k + 1) % 3]) * (z[k] - z[(k + 2) % 3]);
      const Complex step = (((z[k] + c[2]) * z[k] + c[1]) * z[k] + c[0]) / others;
      z[k] -= step;
      moved = std::max(moved, std::abs(step));
    }
    if (moved < 1e-15) break;
  }
  return std::max({std::abs(z[0]), std::abs(z[1]), std::abs(z[2])});
}

// Of y_{n+3} + c₂ y_{n+2} + c₁ y_{n+1} + c₀ y_n = 0 in both components of both sequences, from the end of the first
// step on: what a start makes of the accelerations is its own.
double radius_of_recurrence(const Sequence& a, const Sequence& b) {
  // Least squares, by the normal equations.
  Matrix3d square = Matrix3d::Zero();
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  for (const Sequence* y : {&a, &b})
    for (std::size_t n = 1; n + 3 <= kPropagations; ++n)
      for (Eigen::Index k = 0; k < 2; ++k) {
        const Eigen::Vector3d known((*y)[n][k], (*y)[n + 1][k], (*y)[n + 2][k]);
        square += known * known.transpose();
        side -= (*y)[n + 3][k] * known;
      }
  return radius(Eigen::Vector3d(square.inverse() * side));
}

Complex eigenvalue(double hw, double zeta) {  // h λ of one of the pair, |ζ| < 1
  return hw * Complex(-zeta, std::sqrt(1 - zeta * zeta));
}

}  // namespace

std::string Oscillator::name() const {
  return fmt::format("{}{}{}", rotation ? "rotation, " : "translation, ", constrained ? "on a joint" : "free",
                     damping > 0 ? fmt::format(", damping {:g}", damping) : "");
}

std::optional<double> spectral_radius(const Oscillator& oscillator, std::string_view name, std::string_view formulation,
                                      double hw) {
  const IntegratorEntry& integrator = integrators().require(name);
  Settings settings;
  settings.integrator = name;
  settings.formulation = formulation;
  settings.step = hw;
  settings.end = kPropagations * hw;
  settings.tolerance = 1e-10;
  settings.rtol = settings.atol.emplace(1e-14);
  const Sequence a = sequence(oscillator, false, integrator, settings);
  const Sequence b = sequence(oscillator, true, integrator, settings);
  if (a.size() != kPropagations + 1 || b.size() != kPropagations + 1) return {};
  Matrix2d M;
  M << a[1], b[1];
  constexpr double kSame = 1e-4;
  const double off = std::max((a[2] - M * a[1]).norm(), (b[2] - M * b[1]).norm());
  return off < kSame * std::max(1.0, (M * M).norm()) ? radius(M) : radius_of_recurrence(a, b);
}

double generalized_alpha_radius(double hw, double zeta, double rho) {
  const double m = (2 * rho - 1) / (rho + 1), f = rho / (rho + 1), gamma = 0.5 + f - m,
               beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
  // z = (x, h v, h² a): x₁ = x + v + (½ − β) a + β a₁, v₁ = v + (1 − γ) a + γ a₁,
  // (1 − m) a₁ + m a = −(1 − f) (2 ζ hw v₁ + hw² x₁) − f (2 ζ hw v + hw² x)
  Matrix3d left, right;
  const double c = 2 * zeta * hw, k = hw * hw;
  left << 1, 0, -beta, 0, 1, -gamma, (1 - f) * k, (1 - f) * c, 1 - m;
  right << 1, 1, 0.5 - beta, 0, 1, 1 - gamma, -f * k, -f * c, -m;
  const Matrix3d M = left.inverse() * right;
  // Characteristic polynomial: z³ − tr M z² + ½ (tr² M − tr M²) z − det M.
  const double trace = M.trace();
  return radius(Eigen::Vector3d(-M.determinant(), (trace * trace - (M * M).trace()) / 2, -trace));
}

double radau5_radius(double hw, double zeta) {
  const Complex z = eigenvalue(hw, zeta);
  return std::abs((1.0 + 2.0 / 5 * z + z * z / 20.0) / (1.0 - 3.0 / 5 * z + 3.0 / 20 * z * z - z * z * z / 60.0));
}

double implicit_euler_radius(double hw, double zeta) {
  return 1 / std::abs(1.0 - eigenvalue(hw, zeta));
}

double verlet_radius(double hw) {
  const double half = 1 - hw * hw / 2;
  return std::abs(half) <= 1 ? 1 : std::abs(half) + std::sqrt(half * half - 1);
}

study::PanelPlot amplification_plot(bool quick) {
  study::PanelPlot plot{"amplification", "Spectral radius of a step of an oscillator", "h w", "spectral radius"};
  plot.log_y = false;
  std::vector<double> at;
  const int per_decade = quick ? 3 : 10;
  for (int k = -2 * per_decade; k <= 3 * per_decade / 2; ++k)  // beyond, the roots of α are too near one another
    at.push_back(std::pow(10, static_cast<double>(k) / per_decade));
  for (const double damping : {0.0, 0.5}) {
    for (const bool rotation : {false, true}) {
      for (const bool constrained : {false, true}) {
        const Oscillator oscillator{rotation, constrained, damping};
        for (const IntegratorEntry& integrator : integrators()) {
          if (integrator.analysis != Analysis::dynamics || integrator.picks) continue;
          for (const FormulationEntry& formulation : formulations()) {
            if (refusal_of(integrator, formulation.name)) continue;
            study::Curve curve{oscillator.name(), std::string(integrator.name), std::string(formulation.name), {}};
            for (const double hw : at)
              if (const auto r = spectral_radius(oscillator, integrator.name, formulation.name, hw); r && *r <= kDrawn)
                curve.points.push_back({hw, *r});
            if (!curve.points.empty()) plot.curves.push_back(std::move(curve));
          }
        }
        const double rho = kSpectralRadius.by_default;
        const auto guide = [&](const char* name, const auto& of) {
          study::Curve curve{oscillator.name(), name, study::kGuide, {}};
          for (const double hw : at) curve.points.push_back({hw, of(hw)});
          plot.curves.push_back(std::move(curve));
        };
        guide("α", [&](double hw) { return generalized_alpha_radius(hw, damping, rho); });
        guide("Radau IIA", [&](double hw) { return radau5_radius(hw, damping); });
        guide("Euler", [&](double hw) { return implicit_euler_radius(hw, damping); });
      }
    }
  }
  return plot;
}

}  // namespace poinsot::stability
