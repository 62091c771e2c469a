#include "integrators/stepping/by_mechanism.h"

#include <cstddef>
#include <limits>

#include "core/index.h"
#include "core/mechanisms.h"

namespace poinsot {

std::vector<int> freedoms(const Problem& problem, std::span<const int> mechanism) {
  std::vector<int> freedoms(mechanism_count(mechanism));
  if (mechanism.empty()) return freedoms;
  const Model& model = problem.model();
  const int rows = static_cast<int>(problem.model_rows().size());
  const int per_body = (problem.nv() - (problem.nc() - rows)) / problem.bodies();  // less its normalization
  for (const int of : mechanism) freedoms[index(of)] += per_body;
  for (const int k : problem.model_rows()) {
    const Row& row = model.rows[index(k)];
    if (row.i != kGround || row.j != kGround) --freedoms[index(mechanism[index(row.i == kGround ? row.j : row.i)])];
  }
  return freedoms;
}

std::vector<double> kinetic_noise(const Model& model, std::span<const int> mechanism, double h) {
  const double speed = 1e3 * std::numeric_limits<double>::epsilon() / h;
  std::vector<double> noise(mechanism_count(mechanism));
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    noise[index(mechanism[b])] +=
        0.5 * speed * speed * (body.mass * body.position.squaredNorm() + body.inertia.trace());
  }
  return noise;
}

}  // namespace poinsot
