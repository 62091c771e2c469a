#include "bench/study/natural_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "core/input_error.h"
#include "integrators/simulate.h"

namespace poinsot::study {
namespace {

constexpr double kTravel = 15;        // rad, or sizes of the mechanism
constexpr double kLast = 1000;        // s
constexpr double kLongestSearch = 2;  // s of computing

// The nearest of 1, 2, 3, 5 times a power of ten, by ratio.
double rounded(double t) {
  const int exponent = static_cast<int>(std::floor(std::log10(t)));
  double best = 0;
  for (const int factor : {1, 2, 3, 5, 10}) {
    const double round = std::stod(fmt::format("{}e{}", factor, exponent));
    if (best == 0 || std::abs(std::log(t / round)) < std::abs(std::log(t / best))) best = round;
  }
  return best;
}

}  // namespace

double natural_end(const Scene& scene) {
  double size = 0;
  for (const Body& body : scene.bodies) size = std::max(size, body.position.norm());
  if (size == 0) size = 1;
  Settings settings;  // good for stiff scenes; as accurate as a reference, to come to an end where that would
  settings.integrator = "radau5";
  settings.rtol = 1e-12;
  settings.atol = 1e-14;
  settings.end = kLast;
  struct Enough {};
  const auto began = std::chrono::steady_clock::now();
  std::vector<BodyState> bodies(scene.bodies.size()), before;
  std::vector<double> travel(2 * bodies.size());  // angle and path of each
  double t = 0;
  bool reached = false;
  const auto watch = [&](const Sample& sample) {
    sample.problem.to_bodies(sample.a, bodies);
    for (std::size_t b = 0; b < before.size(); ++b) {
      travel[2 * b] += (sample.t - t) * (before[b].w.norm() + bodies[b].w.norm()) / 2;
      travel[2 * b + 1] += (sample.t - t) * (before[b].rd.norm() + bodies[b].rd.norm()) / 2 / size;
    }
    before = bodies;
    t = sample.t;
    reached = *std::max_element(travel.begin(), travel.end()) >= kTravel;
    if (reached || std::chrono::steady_clock::now() - began > std::chrono::duration<double>(kLongestSearch))
      throw Enough{};
  };
  try {
    const Outcome outcome = simulate(scene, settings, watch);
    if (outcome.status.ok()) return 1;
    return t > 0 ? rounded(t / 2) : 1;  // well before where the pilot came to an end
  } catch (const Enough&) {
    return rounded(t);
  } catch (const InputError&) {  // told when the scene is run in earnest
    return 1;
  }
}

}  // namespace poinsot::study
