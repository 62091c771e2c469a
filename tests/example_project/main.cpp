// Simulates a scene for one second and prints where each body ends.
#include <poinsot/core/input_error.h>
#include <poinsot/core/scene_reader.h>
#include <poinsot/integrators/simulate.h>

#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: example SCENE\n");
    return 2;
  }
  try {
    const poinsot::Scene scene = poinsot::read_scene(argv[1]);
    poinsot::Settings settings;
    settings.end = 1;
    std::vector<poinsot::BodyState> last(scene.bodies.size());
    const poinsot::Outcome outcome = poinsot::simulate(
        scene, settings, [&](const poinsot::Sample& sample) { sample.problem.to_bodies(sample.a, last); });
    if (!outcome.status.ok()) {
      std::fprintf(stderr, "%s\n", outcome.status.message.c_str());
      return 3;
    }
    for (std::size_t k = 0; k < last.size(); ++k) {
      std::printf("%s %.6f %.6f %.6f\n", scene.bodies[k].name.c_str(), last[k].r.x(), last[k].r.y(), last[k].r.z());
    }
  } catch (const poinsot::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
