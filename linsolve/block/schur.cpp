#include "linsolve/block/schur.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "core/index.h"

namespace poinsot::block {
namespace {

constexpr int kWidest = 16;
constexpr int kFewestRows = 5;         // the heavy top, with three, takes as long in fronts
constexpr double kLeftOfPivot = 1e-6;  // part of a pivot's size that cancellation leaves, at least

struct SchurKernel {
  int rows, unknowns, panel, panels;
  decltype(&invert_schur<5, 8>) invert;
  decltype(&multipliers<5, 8>) solve;
};
template <int N, int U>
constexpr SchurKernel schur_kernel() {
  return {N, U, kPanel<N>, kPanels<N>, &invert_schur<N, U>, &multipliers<N, U>};
}
// One and two bodies on hinges, without and with a driver; others take one that is larger.
constexpr std::array kSchurKernels{schur_kernel<5, 8>(), schur_kernel<6, 8>(), schur_kernel<8, kWidest>(),
                                   schur_kernel<10, kWidest>(), schur_kernel<12, kWidest>()};

struct PartKernel {
  decltype(&invert_in_order<1>) invert;
  decltype(&left<1>) left;
  decltype(&right<1>) right;
};
template <int... P>
constexpr auto part_kernels(std::integer_sequence<int, P...>) {
  return std::array{PartKernel{&invert_in_order<P + 1>, &left<P + 1>, &right<P + 1>}...};
}
constexpr auto kPartKernels = part_kernels(std::make_integer_sequence<int, kKernels - 1>());
const PartKernel& part_kernel(int size) {
  return kPartKernels[index(size - 1)];
}

int size_of(const std::vector<int>& x) {
  return static_cast<int>(x.size());
}

constexpr std::size_t kLine = 8;  // numbers
std::size_t lines(std::size_t numbers) {
  return (numbers + kLine - 1) / kLine * kLine;
}

bool any(Bits lanes) {
  std::int64_t one = 0;
  for (int lane = 0; lane < kLanes; ++lane) one |= lanes[lane];
  return one != 0;
}

template <class Visit>
void visit_entries(const CscLayout& layout, Visit&& visit) {
  for (int j = 0; j < layout.n; ++j)
    for (int k = layout.start[index(j)]; k < layout.start[index(j) + 1]; ++k) visit(layout.row[index(k)], j);
}

}  // namespace

bool Schur::lay_out(const Pattern& pattern, const CscLayout& layout) {
  if (layout.n > 2 * kWidest || !find_parts(pattern, layout)) return false;
  const auto kernel = std::ranges::find_if(
      kSchurKernels, [&](const SchurKernel& k) { return k.rows >= rows_ && k.unknowns >= size_of(unknown_); });
  if (rows_ < kFewestRows || kernel == kSchurKernels.end()) return false;
  kernel_ = static_cast<std::size_t>(kernel - kSchurKernels.begin());
  row_.resize(index(kernel->rows), row_.front());
  step_ = padded(kernel->rows);
  if (!place_values(pattern, layout)) return false;
  find_panels(layout);
  dense_.resize(index(rows_ * rows_)), size_.resize(index(rows_));
  return true;
}

// What is eliminated, and how K falls apart. False where a part has no kernel, or constraints share an entry.
bool Schur::find_parts(const Pattern& pattern, const CscLayout& layout) {
  const auto node = [&](int k) { return index(pattern.node[index(k)]); };
  std::vector<char> on_body(1 + index(*std::ranges::max_element(pattern.node)), 0);
  visit_entries(layout, [&](int i, int j) { on_body[node(i)] |= node(i) == node(j); });
  bool fits = true;
  std::vector<int> part(index(layout.n));  // by unknown: the first of its part
  std::iota(part.begin(), part.end(), 0);
  visit_entries(layout, [&](int i, int j) {
    if (on_body[node(i)] != on_body[node(j)]) return;
    fits = fits && on_body[node(i)];
    const int a = part[index(i)], b = part[index(j)];
    if (a != b) std::ranges::replace(part, std::max(a, b), std::min(a, b));
  });
  unknown_.clear(), row_.clear(), columns_.clear(), parts_.clear();
  for (int k = 0; k < layout.n; ++k) (on_body[node(k)] ? unknown_ : row_).push_back(k);
  rows_ = size_of(row_);
  for (const bool single : {true, false}) {
    if (!single) singles_ = size_of(columns_), numbers_ = index(singles_);
    for (int first = 0; first < layout.n; ++first) {
      const int size = static_cast<int>(std::ranges::count(part, first));
      if (size == 0 || (size == 1) != single || !on_body[node(first)]) continue;
      fits = fits && size < kKernels;
      if (!single) parts_.push_back({size, size_of(columns_), static_cast<int>(numbers_), false});
      numbers_ += single ? 0 : index(size * size);
      for (int c = 0; c < size_of(unknown_); ++c)
        if (part[index(unknown_[index(c)])] == first) columns_.push_back(c);
    }
  }
  return fits;
}

// Where the values go. False where rows of a pattern's block do not follow one after the other there.
bool Schur::place_values(const Pattern& pattern, const CscLayout& layout) {
  const SchurKernel& kernel = kSchurKernels[kernel_];
  const std::size_t K = lines(numbers_), columns = unknown_.size() * index(step_);
  const std::size_t square = index(kernel.rows * step_), B = K + columns;
  values_ = B + index(kernel.rows * kernel.unknowns);
  room_.assign(values_ + 2 * K + columns + 2 * square + 3 * index(step_) + index(kernel.unknowns) + 9 * kLine, 0);
  const std::size_t past = reinterpret_cast<std::uintptr_t>(room_.data()) / sizeof(double) % kLine;
  double* next = room_.data() + (kLine - past) % kLine;
  const auto take = [&](std::size_t numbers) { return std::exchange(next, next + lines(numbers)); };
  K_ = take(values_), K_then_ = take(K), inverse_ = take(K), L_ = take(columns), S_ = take(square);
  border_ = take(square), lambda_ = take(index(step_)), forces_ = take(index(kernel.unknowns));
  pivots_ = take(index(step_)), chosen_ = take(index(step_));
  G_ = K_ + K, B_ = K_ + B;
  for (int k = rows_; k < kernel.rows; ++k) border_[k * step_ + k] = 1;
  std::fill_n(chosen_, step_, 1.0);
  order_.assign(unknown_.size(), 0);
  units_.assign(unknown_.size(), 1), then_ = units_;

  // By unknown: its column of G or row of S, the start of its block of K, the block's size, and its place there.
  std::vector<int> place(index(layout.n), 0), block(place), size(place), within(place);
  for (int c = 0; c < size_of(unknown_); ++c) place[index(unknown_[index(c)])] = c;
  for (int k = 0; k < rows_; ++k) place[index(row_[index(k)])] = k;
  const auto unknown_at = [&](int column) { return index(unknown_[index(columns_[index(column)])]); };
  for (int k = 0; k < singles_; ++k) block[unknown_at(k)] = k, size[unknown_at(k)] = 1;
  for (const Part& part : parts_)
    for (int k = 0; k < part.size; ++k) {
      const std::size_t unknown = unknown_at(part.column + k);
      block[unknown] = part.block, size[unknown] = part.size, within[unknown] = k;
    }
  const auto target = [&](int i, int j) {
    const std::size_t row = index(i), column = index(j);
    if (size[column] == 0) return static_cast<int>(B) + place[column] * kernel.unknowns + place[row];
    if (size[row] == 0) return static_cast<int>(K) + place[column] * step_ + place[row];
    return block[column] + within[column] * size[column] + within[row];
  };
  slots_.clear(), strips_.clear();
  const int* slot = layout.slots.data();
  for (const Block& of : pattern.blocks)
    for (int c = 0; c < of.cols; ++c, ++slot) {
      slots_.push_back(target(of.row, of.col + c));
      strips_.push_back({slots_.back(), *slot, of.rows});
      for (int r = 1; r < of.rows; ++r)
        if (target(of.row + r, of.col + c) != slots_.back() + r) return false;
    }
  return true;
}

void Schur::find_panels(const CscLayout& layout) {
  const SchurKernel& kernel = kSchurKernels[kernel_];
  panel_.clear(), panel_end_.clear();
  std::vector<std::size_t> end;
  for (int panel = 0; panel < kernel.panels; ++panel) {
    for (int c = 0; c < size_of(unknown_); ++c)
      for (int k = panel * kernel.panel; k < std::min(rows_, (panel + 1) * kernel.panel); ++k) {
        const auto column = layout.row.begin() + layout.start[index(row_[index(k)])];
        const auto last = layout.row.begin() + layout.start[index(row_[index(k)] + 1)];
        if (std::find(column, last, unknown_[index(c)]) == last) continue;
        panel_.push_back(static_cast<std::uint8_t>(c));
        break;
      }
    end.push_back(panel_.size());
  }
  for (const std::size_t e : end) panel_end_.push_back(panel_.data() + e);
}

void Schur::copy_values(std::span<double> to) const {
  for (const Strip& strip : strips_) std::copy_n(K_ + strip.source, strip.length, to.data() + strip.target);
}

void Schur::take_values(std::span<const double> from) {
  for (const Strip& strip : strips_) std::copy_n(from.data() + strip.target, strip.length, K_ + strip.source);
}

// Whether K is another than the one that is inverted, which then is this one.
bool Schur::inertia_changed() {
  Bits differ = {};
  for (std::size_t i = 0; i < numbers_; i += kLanes) differ |= load(K_ + i) != load(K_then_ + i);
  if (!any(differ)) return false;
  std::copy_n(K_, numbers_, K_then_);
  return true;
}

Choice Schur::choice(const Part& part) {
  const std::size_t first = index(part.column);
  return {order_.data() + first, units_.data() + first, then_.data() + first, part.moved, true, true, true};
}

bool Schur::invert_parts() {
  drift_ = {};
  for (int k = 0; k < singles_; ++k) {
    drift_.add(std::abs(K_[k]) * double{units_[index(k)]} * double{then_[index(k)]});
    inverse_[k] = 1 / K_[k];
  }
  std::array<double, (kKernels - 1) * (kKernels - 1)> by_order;
  for (const Part& part : parts_) {
    const int p = part.size;
    double* D = inverse_ + part.block;
    std::copy_n(K_ + part.block, p * p, D);
    if (!part_kernel(p).invert(D, choice(part), kReluctance * kReluctance, drift_)) {
      drift_ = {0, HUGE_VAL, 0};
      return false;
    }
    if (!part.moved) continue;
    std::copy_n(D, p * p, by_order.data());
    for (int k = 0; k < p; ++k) std::copy_n(by_order.data() + k * p, p, D + order_[index(part.column + k)] * p);
  }
  return true;
}

void Schur::find_left() {
  const int step = step_;
  for (int k = 0; k < singles_; ++k) {
    const int column = columns_[index(k)] * step;
    const double *g = G_ + column, by = inverse_[k];
    double* l = L_ + column;
    for (int i = 0; i < step; i += kLanes) store(l + i, load(g + i) * by);
  }
  for (const Part& part : parts_)
    part_kernel(part.size).left(inverse_ + part.block, G_, L_, &columns_[index(part.column)], step_);
}

bool Schur::choose(std::span<const double> units) {
  (void)inertia_changed();
  for (std::size_t k = 0; k < columns_.size(); ++k) units_[k] = in_range(units[index(unknown_[index(columns_[k])])]);
  for (int k = 0; k < singles_; ++k) then_[index(k)] = in_range(1 / (std::abs(K_[k]) * double{units_[index(k)]}));
  for (Part& part : parts_) {
    Choice of_part = choice(part);
    of_part.keep = false;
    block::choose(K_ + part.block, part.size, of_part);
    part.moved = of_part.moved;
    for (int k = 0; k < part.size; ++k) {
      double size = 0;
      for (int i = 0; i < part.size; ++i)
        size = std::max(size, std::abs(K_[part.block + k * part.size + i]) * double{of_part.weight[i]});
      if (!(kLeftOfPivot * size * double{of_part.then[k]} < 1)) return false;
    }
  }
  if (!invert_parts()) return false;
  find_left();
  return choose_pivots();
}

// Those of S are taken as they come: it is definite where K is.
bool Schur::choose_pivots() {
  const int n = rows_, stride = kSchurKernels[kernel_].unknowns;
  std::ranges::fill(dense_, 0.0);
  const auto at = [&](int i, int k) -> double& { return dense_[index(k * n + i)]; };
  for (int k = 0; k < n; ++k) {
    for (int c = 0; c < size_of(unknown_); ++c)
      for (int i = 0; i < n; ++i) at(i, k) += L_[c * step_ + i] * B_[k * stride + c];
    size_[index(k)] = std::abs(at(k, k));
  }
  for (int k = 0; k < n; ++k) {
    const double pivot = at(k, k);
    if (!(std::abs(pivot) > kLeftOfPivot * size_[index(k)])) return false;
    chosen_[k] = 1 / std::abs(pivot);
    for (int j = k + 1; j < n; ++j)
      for (int i = k + 1; i < n; ++i) at(i, j) -= at(i, k) / pivot * at(k, j);
  }
  return true;
}

bool Schur::factor(double range) {
  if (inertia_changed()) (void)invert_parts();
  find_left();
  kSchurKernels[kernel_].invert(L_, B_, {border_, panel_.data(), panel_end_.data()}, S_, pivots_);
  Bits far = {};  // or not a number
  for (int k = 0; k < step_; k += kLanes) {
    const Vec ratio = magnitude(load(pivots_ + k)) * load(chosen_ + k);
    far |= ~(ratio * range >= 1) | ~(ratio <= range);
  }
  return !any(far) && drift_.within(range);
}

void Schur::solve(std::span<double> b) {
  const int* unknown = unknown_.data();
  kSchurKernels[kernel_].solve({L_, B_, S_, unknown, unknown + unknown_.size(), row_.data(), lambda_, forces_},
                               b.data());
  for (int k = 0; k < singles_; ++k) {
    const int column = columns_[index(k)];
    double& x = b[index(unknown[column])];
    x = inverse_[k] * (x - forces_[column]);
  }
  for (const Part& part : parts_)
    part_kernel(part.size).right(inverse_ + part.block, &columns_[index(part.column)], unknown, forces_, b.data());
  for (int k = 0; k < rows_; ++k) b[index(row_[index(k)])] = lambda_[k];
}

}  // namespace poinsot::block
