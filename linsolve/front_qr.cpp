#include "linsolve/front_qr.h"

#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/index.h"
#include "linsolve/lists.h"

namespace poinsot {
namespace {

constexpr double kNothing = 1e-13;      // left of a column of unit length
constexpr double kClear = 0.2;          // of a column of unit length: it need not wait
constexpr double kLeansOn = 1e-3;       // of a column of unit length
constexpr double kFarApart = 100;       // |y| that a few bodies do not come to
constexpr int kSigns = 3;               // vectors of signs by which columns that lean far are found
constexpr Eigen::Index kMostWait = 16;  // columns of a front

}  // namespace

FrontQr::FrontQr(const Sparse& A, const std::vector<char>& left_out, double tolerance, Choice choice, std::size_t most)
    : tolerance_(tolerance),
      choice_(choice),
      most_(most),
      column_(index(A.cols())),
      place_(column_.size()),
      known_(column_.size()),
      grown_(column_.size()),
      local_(2 * column_.size()) {
  std::mt19937 random(1);
  const auto sign = [&] { return random() % 2 == 0 ? 1.0 : -1.0; };
  std::ranges::generate(known_, sign);
  if (choice_ == Choice::calmest) leaning_ = Eigen::MatrixXd::NullaryExpr(kSigns, A.cols(), sign);
  const int n = static_cast<int>(A.cols());
  Sparse kept = A;
  kept.prune([&](Eigen::Index row, Eigen::Index, double value) { return value != 0 && !left_out[index(row)]; });
  kept.makeCompressed();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> P(n);
  Eigen::COLAMDOrdering<int>()(kept, P);
  for (int k = 0; k < n; ++k) place_[index(k)] = P.indices()[k];
  for (int k = 0; k < n; ++k) column_[index(place_[index(k)])] = k;

  RowMajor by_row(kept.rows(), n);
  Eigen::VectorXi entries = Eigen::VectorXi::Zero(kept.rows());
  for (Eigen::Index k = 0; k < kept.nonZeros(); ++k) ++entries[kept.innerIndexPtr()[k]];
  by_row.reserve(entries);
  for (int place = 0; place < n; ++place)
    for (Sparse::InnerIterator it(kept, column_[index(place)]); it; ++it)
      by_row.insertBackUncompressed(it.row(), place) = it.value();
  const Lists begin = Lists::collect(n, [&](auto&& emit) {
    for (int row = 0; row < by_row.outerSize(); ++row)
      if (const RowMajor::InnerIterator first(by_row, row); first) emit(static_cast<int>(first.col()), row);
  });
  std::vector<Parts> parts(index(n));
  R_.reserve(2 * index(kept.nonZeros()));  // what most come to
  for (int place = 0; place < n; ++place) {
    const int at = assemble(place, by_row, begin[place], parts[index(place)]);
    Front& front = fronts_[index(at)];
    reduce(front);
    if (front.left().size() == 0) {
      free_.push_back(at);
      continue;
    }
    Parts& to = parts[index(front.places[index(front.first)])];
    (to.first < 0 ? to.first : fronts_[index(to.last)].next) = at;
    to.last = at;
  }
  std::vector<Front>().swap(fronts_);
  std::vector<int>().swap(free_);
  column_ = std::move(order_);
  for (int k = 0; k < n; ++k) place_[index(column_[index(k)])] = k;
  for (Entry& entry : R_) entry.place = place_[index(entry.place)];
}

// All rows that begin at `place`: which of the fronts they are. A part alone is taken as it is: the columns of one
// joint share a front.
int FrontQr::assemble(int place, const RowMajor& A, std::span<const int> begins, const Parts& parts) {
  if (begins.empty() && parts.first >= 0 && parts.first == parts.last) return parts.first;
  if (free_.empty()) {
    free_.push_back(static_cast<int>(fronts_.size()));
    fronts_.emplace_back();
  }
  const int at = free_.back();
  free_.pop_back();
  Front& front = fronts_[index(at)];
  front.places.clear();
  front.height = static_cast<Eigen::Index>(begins.size());
  front.top = front.first = 0;
  front.next = -1;
  for (const int row : begins)
    for (RowMajor::InnerIterator it(A, row); it; ++it) front.places.push_back(static_cast<int>(it.col()));
  for (int p = parts.first; p >= 0; p = fronts_[index(p)].next) {
    Front& part = fronts_[index(p)];
    front.height += part.left().rows();
    front.places.insert(front.places.end(), part.places.begin() + part.first, part.places.end());
  }
  std::sort(front.places.begin(), front.places.end());
  front.places.erase(std::unique(front.places.begin(), front.places.end()), front.places.end());
  if (front.places.empty()) front.places.push_back(place);
  for (std::size_t k = 0; k < front.places.size(); ++k) local_[index(front.places[k])] = static_cast<int>(k);

  front.numbers.assign(index(front.height * front.width()), 0.0);
  Eigen::Index next = 0;
  for (const int row : begins) {
    for (RowMajor::InnerIterator it(A, row); it; ++it) front.column(local_[index(it.col())])[next] = it.value();
    ++next;
  }
  for (int p = parts.first; p >= 0; p = fronts_[index(p)].next) {
    Front& part = fronts_[index(p)];
    const auto left = part.left();
    for (Eigen::Index k = 0; k < left.cols(); ++k)
      front.column(local_[index(part.places[index(part.first + k)])]).segment(next, left.rows()) = left.col(k);
    next += left.rows();
    free_.push_back(p);
  }
  return at;
}

// Takes the first column off the front, or lets it wait.
void FrontQr::reduce(Front& front) {
  // More rows than columns say nothing more than a triangle does. Not every time, so that a wide front that is added to
  // often costs no more than its own elimination.
  if (2 * front.left().rows() > 3 * front.left().cols()) {
    const Eigen::Index columns = front.left().cols();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(front.left());
    front.places.erase(front.places.begin(), front.places.begin() + front.first);
    front.numbers.assign(index(columns * columns), 0.0);
    front.height = columns;
    front.top = front.first = 0;
    front.left().triangularView<Eigen::Upper>() = qr.matrixQR().topRows(columns);
  }
  const double norm = front.left().col(0).norm();
  if (choice_ != Choice::by_order && norm > kNothing && clarity(front, 0, norm) < kClear)
    wait(front);
  else
    take(front, 0, norm);
  if (choice_ != Choice::by_order) settle_waiting(front);
}

int FrontQr::column_at(const Front& front, Eigen::Index k) const {
  const int place = front.places[index(front.first + k)];
  return waits(place) ? place - static_cast<int>(column_.size()) : column_[index(place)];
}

// What is left of column k, which is `norm`, for the calmest less where its y would be above kFarApart: kept one after
// the other such columns make y grow with the power of their number, though enough is left of each.
double FrontQr::clarity(const Front& front, Eigen::Index k, double norm) const {
  if (choice_ != Choice::calmest) return norm;
  const double known = leaning_.col(column_at(front, k)).cwiseAbs().maxCoeff();
  return norm * std::min(1.0, kFarApart * kClear / known);
}

void FrontQr::wait(Front& front) {
  front.places.push_back(static_cast<int>(column_.size()) + column_at(front, 0));
  front.numbers.resize(index(front.height * front.width()));
  front.column(front.width() - 1) = front.column(front.first);
  ++front.first;
}

// Those of which nothing is left go, and of too many the clearest. Where no other columns are left, so do all.
void FrontQr::settle_waiting(Front& front) {
  const auto first_waiting = [&]() -> Eigen::Index {
    return std::ranges::find_if(front.places, [&](int place) { return waits(place); }) - front.places.begin() -
           front.first;
  };
  while (front.left().cols() > first_waiting()) {
    const Eigen::Index first = first_waiting(), count = front.left().cols() - first;
    Eigen::Index least = 0;
    const Eigen::RowVectorXd norms = front.left().rightCols(count).colwise().norm();
    const double smallest = norms.minCoeff(&least), largest = norms.maxCoeff();
    if (largest <= tolerance_) most_left_ = std::max(most_left_, largest);
    if (!(smallest > kNothing)) {
      take(front, first + least, smallest);
    } else if (first == 0 || count > (largest > tolerance_ ? kMostWait : 4 * kMostWait)) {
      const auto worth = [&](Eigen::Index k) {
        return std::pair(norms[k] > tolerance_, clarity(front, first + k, norms[k]));
      };
      Eigen::Index clearest = 0;
      for (Eigen::Index k = 1; k < count; ++k)
        if (worth(clearest) < worth(k)) clearest = k;
      take(front, first + clearest, norms[clearest]);
    } else {
      return;
    }
  }
}

// Column k of what is left, whose norm that is.
void FrontQr::take(Front& front, Eigen::Index k, double norm) {
  const int row = static_cast<int>(order_.size());
  order_.push_back(column_at(front, k));
  auto left = front.left();
  if (norm > tolerance_) {
    double tau = 0, beta = 0;
    left.col(k).makeHouseholderInPlace(tau, beta);
    if (reflected_.size() < left.cols()) reflected_.resize(left.cols());
    const auto v = left.col(k).tail(left.rows() - 1);
    left.leftCols(k).applyHouseholderOnTheLeft(v, tau, reflected_.data());
    left.rightCols(left.cols() - k - 1).applyHouseholderOnTheLeft(v, tau, reflected_.data());
    left(0, k) = beta;
    const double y = known_[index(order_.back())] / beta;
    growth_ = std::max(growth_, std::abs(y));
    const Eigen::VectorXd others = choice_ == Choice::calmest ? leaning_.col(order_.back()) / beta : Eigen::VectorXd();
    for (Eigen::Index j = 0; j < left.cols(); ++j) {
      if (left(0, j) == 0) continue;
      const int column = column_at(front, j);
      known_[index(column)] -= left(0, j) * y;
      if (choice_ == Choice::calmest) leaning_.col(column) -= left(0, j) * others;
      if (std::abs(left(0, j)) > kLeansOn) grown_[index(column)] = std::max(grown_[index(column)], std::abs(y));
      if (has_R_) R_.push_back({row, column, left(0, j)});
    }
    ++front.top;
  } else {
    most_left_ = std::max(most_left_, norm);
    const double grown = grown_[index(order_.back())];
    if (grown > kFarApart && norm > kNothing) ++stretched_;
    dependent_.push_back(order_.back());
    if (dependent_.size() > most_) std::vector<Entry>().swap(R_), has_R_ = false;
  }
  if (!waits(front.places[index(front.first + k)])) {
    ++front.first;
    return;
  }
  front.column(front.first + k) = front.column(front.width() - 1);
  front.places[index(front.first + k)] = front.places.back();
  front.places.pop_back();
  front.numbers.resize(index(front.height * front.width()));
}

}  // namespace poinsot
