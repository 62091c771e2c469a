#include "linsolve/block/factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "linsolve/block/assembly.h"
#include "linsolve/lanes.h"

namespace poinsot::block {
namespace {

// Kernels by the number of pivots; the first is that for any number.
std::size_t kernel(int pivots) {
  return pivots < kKernels ? index(pivots) : 0;
}
template <int... P>
constexpr auto eliminations(std::integer_sequence<int, P...>) {
  return std::array{&block::eliminate<P>...};
}
template <bool Moved, int... P>
constexpr auto forwards(std::integer_sequence<int, P...>) {
  return std::array{&block::forward<P, Moved>...};
}
template <bool Whole, int... P>
constexpr auto backwards(std::integer_sequence<int, P...>) {
  return std::array{&block::backward<P, Whole>...};
}
constexpr auto kEliminate = eliminations(std::make_integer_sequence<int, kKernels>());
constexpr std::array kForward{forwards<false>(std::make_integer_sequence<int, kKernels>()),
                              forwards<true>(std::make_integer_sequence<int, kKernels>())};
constexpr std::array kBackward{backwards<false>(std::make_integer_sequence<int, kKernels>()),
                               backwards<true>(std::make_integer_sequence<int, kKernels>())};

// A factor that no cache holds is fetched ahead: its fronts are a kilobyte or two each, and the processor's own
// prefetching begins anew at every page.
constexpr std::size_t kAhead = 8;          // fronts
constexpr std::size_t kCached = 1u << 17;  // doubles: 1 MB

inline void fetch(const double* from, int doubles) {
  constexpr int kLine = 8;
  for (int i = 0; i < doubles; i += kLine) __builtin_prefetch(from + i);
}

}  // namespace

void Factor::resize(const Schedule& s) {
  store_.assign(index(s.store_size + kLanes), 0);  // whole vectors are loaded at its end as well
  stack_.assign(index(s.stack_size), 0);
  update_.assign(index(s.largest_update), 0);
  t_.assign(index(s.largest_rows + s.largest_pivots), 0);
  then_.assign(index(s.n), 1);
  weight_.assign(index(s.n), 1);
  y_.assign(index(s.n + kLanes), 0);
  order_.assign(index(s.n), 0);
  moved_.assign(s.fronts.size(), 0);
  whole_.assign(s.fronts.size(), 0);
  places_.assign(s.fronts.size(), {});
  inverses_ = true;
  const int* child = s.children.data();
  for (std::size_t k = 0; k < s.fronts.size(); ++k) {
    const int* end = s.children.data() + s.fronts[k].children;
    if (child != end && block::lays_down(s.fronts[index(*child)], s.fronts[k]))
      places_[k] = block::places(s.fronts[index(*child)], s.stretches.data());
    child = end;
  }
}

Drift Factor::factor(const Schedule& s, std::span<const double> values, bool keep_order, std::span<const double> b,
                     bool only) {
  Drift drift;
  const Pass pass{s.unknown.data(), s.other.data(), y_.data(), nullptr, t_.data()};
  if (!b.empty()) take(s, b);
  kept_ = !only;
  const Strip* strip = s.strips.data();
  const int* child = s.children.data();
  const std::size_t ahead = store_.size() > kCached ? std::min(kAhead, s.fronts.size()) : s.fronts.size();
  double *U = store_.data(), *fetched = U;
  if (ahead < s.fronts.size())
    for (std::size_t k = 0; k < ahead; ++k) fetched += step(s.fronts[k]);
  for (std::size_t k = 0; k < s.fronts.size(); ++k) {
    const Front& f = s.fronts[k];
    if (k + ahead < s.fronts.size()) {
      const Front &next = s.fronts[k + ahead], &before = s.fronts[k + ahead - 1];
      fetch(fetched, step(next));
      fetched += step(next);
      for (int r = before.strips[4]; r < next.strips[4]; ++r)
        __builtin_prefetch(values.data() + s.strips[index(r)].source);
    }
    double* W = update_.data();
    const int* end = s.children.data() + f.children;
    if (child != end && block::lays_down(s.fronts[index(*child)], f)) {
      block::lay_down(places_[k], stack_.data() + s.fronts[index(*child++)].update, f, U, W);
    } else {
      std::fill_n(U, f.pivots * (f.pivots + f.rows + f.others), 0.0);
      std::fill_n(W, f.rows * f.others, 0.0);
    }
    strip = block::add_strips<1>(strip, s.strips.data() + f.strips[0], values.data(), U);
    strip = block::add_strips<2>(strip, s.strips.data() + f.strips[1], values.data(), U);
    strip = block::add_strips<3>(strip, s.strips.data() + f.strips[2], values.data(), U);
    strip = block::add_strips<4>(strip, s.strips.data() + f.strips[3], values.data(), U);
    for (const Strip* last = s.strips.data() + f.strips[4]; strip != last; ++strip)
      block::add(U + strip->target, values.data() + strip->source, static_cast<int>(strip->length));
    for (; child != end; ++child) {
      const Front& c = s.fronts[index(*child)];
      block::extend_add(c, stack_.data() + c.update, s.stretches.data(), f, U, W);
    }
    Choice choice{order_.data() + f.first,
                  weight_.data() + f.first,
                  then_.data() + f.first,
                  moved_[k] != 0,
                  whole_[k] != 0,
                  keep_order,
                  inverses_};
    kEliminate[kernel(f.pivots)](U, f, W, stack_.data() + f.update, choice, t_.data(), drift);
    moved_[k] = choice.moved;
    whole_[k] = choice.whole;
    if (!b.empty()) kForward[choice.moved][kernel(f.pivots)](pass, f, U + lower(f), order_.data() + f.first);
    U += step(f);
  }
  end_ = U;
  return drift;
}

void Factor::take(const Schedule& s, std::span<const double> b) {
  for (std::size_t k = 0; k < b.size(); ++k) y_[k] = b[index(s.unknown[k])];
}

void Factor::solve(const Schedule& s, std::span<double> b) {
  take(s, b);
  const Front *const begin = s.fronts.data(), *const end = begin + s.fronts.size();
  const std::ptrdiff_t ahead = store_.size() > kCached ? std::min<std::ptrdiff_t>(kAhead, end - begin) : end - begin;
  const Pass pass{s.unknown.data(), s.other.data(), y_.data(), b.data(), t_.data()};
  const char* moved = moved_.data();
  const double *U = store_.data(), *next = U;
  if (ahead < end - begin)
    for (const Front* f = begin; f != begin + ahead; ++f) next += step(*f);
  for (const Front *f = begin, *const fetched = end - ahead; f != end; ++f, ++moved) {
    if (f < fetched) {
      fetch(next + lower(f[ahead]), f[ahead].pivots * f[ahead].rows);
      next += step(f[ahead]);
    }
    kForward[index(*moved)][kernel(f->pivots)](pass, *f, U + lower(*f), order_.data() + f->first);
    U += step(*f);
  }
  back(s, b);
}

void Factor::back(const Schedule& s, std::span<double> b) {
  const Front *const begin = s.fronts.data(), *const end = begin + s.fronts.size();
  const std::ptrdiff_t ahead = store_.size() > kCached ? std::min<std::ptrdiff_t>(kAhead, end - begin) : end - begin;
  const Pass pass{s.unknown.data(), s.other.data(), y_.data(), b.data(), t_.data()};
  const char* whole = whole_.data() + (end - begin);
  const double *U = end_, *next = U;
  if (ahead < end - begin)
    for (const Front* f = end - ahead; f != end; ++f) next -= step(*f);
  for (const Front *f = end, *const fetched = begin + ahead; f-- != begin;) {
    if (f >= fetched) {
      next -= step(f[-ahead]);
      fetch(next, lower(f[-ahead]));
    }
    U -= step(*f);
    kBackward[index(*--whole)][kernel(f->pivots)](pass, *f, U);
  }
}

void Factor::drop_inverses() {
  inverses_ = false;
  std::ranges::fill(whole_, 0);
}

void Factor::weigh_rows(const Schedule& s, std::span<const double> weight) {
  for (std::size_t k = 0; k < weight.size(); ++k) weight_[k] = in_range(weight[index(s.unknown[k])]);
}

}  // namespace poinsot::block
