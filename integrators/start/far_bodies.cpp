#include "integrators/start/far_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/index.h"

namespace poinsot {

void tell_far_bodies(const Model& model, std::vector<std::string>& notices) {
  constexpr double kOfAccount = 1e-8;
  std::vector<double> size(model.bodies.size(), 0);
  const auto reaches = [&](int body, const Vector3& s) {
    if (body == kGround) return;
    size[index(body)] = std::max({size[index(body)], s.norm(), rod_length(model.bodies[index(body)])});
  };
  for (const Row& row : model.rows) {
    reaches(row.i, row.s_i);
    reaches(row.j, row.s_j);
  }
  double most = 0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < size.size(); ++k) {
    const double moved =
        size[k] > 0 ? std::numeric_limits<double>::epsilon() * model.bodies[k].position.norm() / size[k] : 0;
    if (moved > most) most = moved, worst = k;
  }
  if (most <= kOfAccount) return;
  const Body& body = model.bodies[worst];
  notices.push_back(
      fmt::format("body '{}' is {:.3g} m from the origin and {:.3g} m long: every step rounds its position "
                  "by up to {:.1g} of that, and velocities, accelerations and forces by more; place the "
                  "origin near the mechanism",
                  body.name, body.position.norm(), size[worst], most));
}

}  // namespace poinsot
