#include "integrators/start/block_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"

namespace poinsot {
namespace {

using Column = Eigen::SparseMatrix<double>::InnerIterator;

int body_of(const Column& entry) {
  return static_cast<int>(entry.row()) / 6;
}

}  // namespace

BlockRows::BlockRows(const RowSpace& space, std::vector<int> rows) : rows_(std::move(rows)), ends_(rows_.size()) {
  const auto visit = [&](auto&& take) {
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      int last = -1;
      for (Column it(space.columns(), rows_[k]); it; ++it)
        if (body_of(it) != last) take(k, last = body_of(it));
    }
  };
  visit([&](std::size_t, int body) { bodies_.push_back(body); });
  std::ranges::sort(bodies_);
  bodies_.erase(std::unique(bodies_.begin(), bodies_.end()), bodies_.end());
  visit([&](std::size_t k, int body) {
    Ends& of = ends_[k];
    of.body[of.body[0] < 0 ? 0 : 1] = place_of_body(body);
  });
  of_body_ = Lists::collect(static_cast<int>(bodies_.size()), [&](auto&& emit) {
    for (std::size_t k = 0; k < rows_.size(); ++k)
      for (const int body : ends_[k].body)
        if (body >= 0) emit(body, static_cast<int>(k));
  });
  int next = 0;
  for (int body = 0; body < of_body_.size(); ++body)
    for (const int k : of_body_[body]) {
      Ends& of = ends_[index(k)];
      of.part[of.body[0] == body ? 0 : 1] = next++;
    }
  parts_.assign(index(next), Part::Zero());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    int at = -1, last = -1;
    for (Column it(space.columns(), rows_[k]); it; ++it) {
      if (body_of(it) != last) ++at, last = body_of(it);
      to_.push_back(6 * ends_[k].part[at] + static_cast<int>(it.row()) % 6);
    }
  }
}

int BlockRows::place_of_body(int body) const {
  return static_cast<int>(std::ranges::lower_bound(bodies_, body) - bodies_.begin());
}

double BlockRows::products() const {
  double sum = 0;
  for (int body = 0; body < of_body_.size(); ++body) sum += std::pow(of_body_[body].size(), 2);
  return sum;
}

void BlockRows::stand(const RowSpace& space) {
  const double* values = space.columns().valuePtr();
  const int* begin = space.columns().outerIndexPtr();
  double* parts = parts_.front().data();
  const int* to = to_.data();
  for (const int row : rows_)
    for (int k = begin[row]; k < begin[row + 1]; ++k) parts[*to++] = values[k];
}

double BlockRows::dot(int k, int l) const {
  const Ends &a = ends_[index(k)], &b = ends_[index(l)];
  double sum = 0;
  for (int i = 0; i < 2 && a.body[i] >= 0; ++i)
    for (int j = 0; j < 2; ++j)
      if (a.body[i] == b.body[j]) sum += part(a, i).dot(part(b, j));
  return sum;
}

void BlockRows::add(double factor, int k, Eigen::Ref<Eigen::VectorXd> f) const {
  const Ends& of = ends_[index(k)];
  for (int i = 0; i < 2 && of.body[i] >= 0; ++i) f.segment<6>(6 * of.body[i]) += factor * part(of, i);
}

double BlockRows::share(int k, const Eigen::Ref<const Eigen::VectorXd>& f) const {
  const Ends& of = ends_[index(k)];
  double sum = 0;
  for (int i = 0; i < 2 && of.body[i] >= 0; ++i) sum += part(of, i).dot(f.segment<6>(6 * of.body[i]));
  return sum;
}

Eigen::SparseMatrix<double> BlockRows::columns(const RowSpace& space, std::span<const int> some) const {
  Eigen::SparseMatrix<double> of(variables(), static_cast<Eigen::Index>(some.size()));
  of.reserve(12 * static_cast<Eigen::Index>(some.size()));
  for (std::size_t c = 0; c < some.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    of.startVec(column);
    for (Column it(space.columns(), rows_[index(some[c])]); it; ++it)
      if (it.value() != 0) of.insertBack(6 * place_of_body(body_of(it)) + it.row() % 6, column) = it.value();
  }
  of.finalize();
  return of;
}

}  // namespace poinsot
