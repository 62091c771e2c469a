#include "linsolve/block/cancellation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "linsolve/block/kernels.h"

namespace poinsot::block {
namespace {

// A number and its size without cancellation.
struct Sized {
  double value = 0, size = 0;
};

// A whole front, (p + m) × (p + m).
class Square {
 public:
  // From the store of U, D and L.
  void set(const Front& f, const std::vector<Sized>& store) {
    const int p = f.pivots, m = f.others;
    n_ = index(p + m);
    entries_.assign(n_ * n_, {});
    const Sized *U = store.data(), *D = U + p * m, *L = D + p * p;
    for (int j = 0; j < p + m; ++j) {
      std::copy_n(j < p ? D + j * p : U + (j - p) * p, p, &(*this)(0, j));
      if (j < p) std::copy_n(L + j * f.rows, m, &(*this)(0, j) + p);
    }
  }
  Sized& operator()(int i, int j) { return entries_[index(j) * n_ + index(i)]; }

 private:
  std::size_t n_ = 0;
  std::vector<Sized> entries_;
};

// Eliminates p pivots of n, calling visit(k, part) for the part that pivot k is of its size: true where it is to be
// judged as if it were good. The pivots are those of factor_choosing().
template <class Visit>
void eliminate(Square& a, int p, int n, std::span<double> weight, std::vector<Sized>& l, Visit&& visit) {
  l.resize(index(n));
  for (int k = 0; k < p; ++k) {
    int best = k;
    const auto candidate = [&](int i) { return std::abs(a(i, k).value) * weight[index(i)]; };
    for (int i = k + 1; i < p; ++i)
      if (candidate(i) > candidate(best)) best = i;
    if (candidate(best) > block::kReluctance * candidate(k)) {
      for (int j = 0; j < n; ++j) std::swap(a(k, j), a(best, j));
      std::swap(weight[index(k)], weight[index(best)]);
    }
    Sized& pivot = a(k, k);
    if (visit(k, pivot.size > 0 ? std::abs(pivot.value) / pivot.size : 0))
      pivot.value = pivot.size > 0 ? pivot.size : 1;
    for (int i = k + 1; i < n; ++i) {
      const double multiplier = a(i, k).value / pivot.value;
      l[index(i)] = {-multiplier, std::abs(multiplier)};
    }
    for (int j = k + 1; j < n; ++j) {
      const Sized u{a(k, j).value, std::abs(a(k, j).value)};
      if (u.value == 0) continue;
      Sized* column = &a(0, j);
      for (int i = k + 1; i < n; ++i) {  // both at once, as a vector
        column[i].value += l[index(i)].value * u.value;
        column[i].size += l[index(i)].size * u.size;
      }
    }
  }
}

}  // namespace

Cancelled cancelled_pivots(const Schedule& s, std::span<const double> values, std::span<const double> weight,
                           double part) {
  Cancelled found;
  std::vector<Sized> updates(index(s.stack_size));  // m × m, until the parent takes them
  std::vector<Sized> store;
  Square a;
  std::vector<int> places;
  std::vector<double> units;
  std::vector<Sized> multipliers;
  const Strip* strip = s.strips.data();
  const int* child = s.children.data();
  for (const Front& f : s.fronts) {
    const int p = f.pivots, m = f.others, n = p + m;
    store.assign(index(p * (p + f.rows + m)), {});
    for (const Strip* end = s.strips.data() + f.strips.back(); strip != end; ++strip)
      for (unsigned i = 0; i < strip->length; ++i) {
        const double value = values[index(strip->source) + i];
        store[strip->target + i].value += value;
        store[strip->target + i].size += std::abs(value);
      }
    a.set(f, store);
    for (const int* end = s.children.data() + f.children; child != end; ++child) {
      const Front& c = s.fronts[index(*child)];
      places.resize(index(c.others));
      for (int r = c.first_stretch; r < c.last_stretch; ++r) {
        const Stretch& stretch = s.stretches[index(r)];
        for (int i = 0; i < stretch.length; ++i)
          places[index(stretch.from + i)] = stretch.to + i + (r < c.first_outer_stretch ? 0 : p);
      }
      const Sized* update = updates.data() + c.update;
      for (int j = 0; j < c.others; ++j) {
        Sized* column = &a(0, places[index(j)]);
        for (int i = 0; i < c.others; ++i, ++update) {
          column[places[index(i)]].value += update->value;
          column[places[index(i)]].size += update->size;
        }
      }
    }
    units.resize(index(p));
    for (int i = 0; i < p; ++i) units[index(i)] = weight[index(s.unknown[index(f.first + i)])];
    eliminate(a, p, n, units, multipliers, [&](int i, double left) {
      if (!(left >= found.least)) found.least = left;
      if (left > part) return false;
      found.pivots.push_back(f.first + i);
      return true;
    });
    for (int j = 0; j < m; ++j) std::copy_n(&a(p, p + j), m, updates.data() + f.update + j * m);
  }
  return found;
}

}  // namespace poinsot::block
