#include "integrators/start/momentary_spin.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/open_spins.h"
#include "integrators/start/row_space.h"

namespace poinsot {

Status refuse_momentary_spin(const std::shared_ptr<const Model>& model, std::span<const BodyState> states) {
  const std::vector<Body>& bodies = model->bodies;
  if (std::ranges::all_of(bodies, [](const Body& body) { return axes_without_moment(body).isZero(0); })) return {};
  std::vector<int> rows(model->rows.size());
  std::iota(rows.begin(), rows.end(), 0);
  RowSpace space(model, std::move(rows));
  space.stand(0, states);
  std::vector<Matrix3> held(bodies.size(), Matrix3::Zero());
  std::vector<Vector3> turn(bodies.size());  // of one row, by its bodies
  for (int k = 0; k < space.columns().outerSize(); ++k) {
    using Entry = Eigen::SparseMatrix<double>::InnerIterator;
    for (Entry g(space.columns(), k); g; ++g) turn[index(g.row() / 6)].setZero();
    for (Entry g(space.columns(), k); g; ++g)
      if (g.row() % 6 >= 3) turn[index(g.row() / 6)][g.row() % 6 - 3] = g.value();
    for (Entry g(space.columns(), k); g; ++g)
      if (g.row() % 6 == 3) held[index(g.row() / 6)] += turn[index(g.row() / 6)] * turn[index(g.row() / 6)].transpose();
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Vector3 w = unheld_axis(axes_without_moment(bodies[b]), held[b], kDependent * kDependent);
    if (w.isZero(0)) continue;
    return with_remedy(Failure::singular_matrix, 0,
                       "at t = 0 s the linear system is singular: " + describe_no_moment(bodies[b], w) +
                           ", and no constraint holds it about that in the initial pose",
                       "give it a small moment there, or start from another pose");
  }
  return {};
}

}  // namespace poinsot
