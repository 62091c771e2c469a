// A hundred values of a parameter: a pendulum of each length swings once, from the horizontal and back.
#include <poinsot/core/input_error.h>
#include <poinsot/core/scene_reader.h>
#include <poinsot/core/varied_scene.h>
#include <poinsot/integrators/simulate.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: parameters SCENE\n");
    return 2;
  }
  try {
    poinsot::VariedScene varied(poinsot::read_scene(argv[1]));
    double worst = 0;
    for (int k = 0; k < 100; ++k) {
      const double l = 0.51 + 0.01 * k;
      const poinsot::Scene& scene = varied.with({{"l", l}});  // reads again what calls l
      const poinsot::Body& rod = scene.bodies[0];
      poinsot::Settings settings;  // one period: 4 K(sin 45°) √(J/(m g l)), J about the hinge
      settings.end = 4 * 1.8540746773013719 * std::sqrt((rod.inertia(0, 0) / rod.mass + l * l) / (9.81 * l));
      std::vector<poinsot::BodyState> last(1);
      const poinsot::Outcome outcome = poinsot::simulate(
          scene, settings, [&](const poinsot::Sample& sample) { sample.problem.to_bodies(sample.a, last); });
      if (!outcome.status.ok()) {
        std::fprintf(stderr, "l = %g: %s\n", l, outcome.status.message.c_str());
        return 3;
      }
      worst = std::max(worst, (last[0].r - rod.position).norm());
    }
    std::printf("100 lengths, at most %.1e m from where they began\n", worst);
  } catch (const poinsot::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
