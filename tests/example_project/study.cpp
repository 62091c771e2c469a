// Which methods a scene is solved with fastest at each accuracy: a reference, a sweep and its front.
#include <poinsot/bench/study/sweep.h>
#include <poinsot/core/scene_reader.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: study SCENE\n");
    return 2;
  }
  try {
    using namespace poinsot::study;
    const poinsot::Scene scene = poinsot::read_scene(argv[1]);
    std::vector<std::string> notices;
    const Reference exact = reference(scene, {1, 1.0 / kOutputs, 8}, Cache(""), notices);  // to t = 1 s, eight digits
    const Sweep sweep(scene, 1, exact);
    SweepPlan plan = SweepPlan::quick();
    plan.integrators = {"implicit_euler", "dopri5", "dop853"};
    std::vector<Case> cases;
    for (const std::vector<Case>& level : sweep.cases(plan)) cases.insert(cases.end(), level.begin(), level.end());
    const std::vector<Measured> measured = sweep.measure(cases, plan.repetitions);
    const std::vector<bool> on = front(measured, 0, exact);  // of positions: quantity 0
    for (std::size_t k = 0; k < cases.size(); ++k)
      if (on[k]) std::printf("%s %g %g\n", cases[k].method().c_str(), measured[k].error[0], measured[k].seconds);
  } catch (const poinsot::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
