// The block solver: Gaussian elimination over the graph of bodies and groups of constraints.
//
// analyze() chooses the order by structure (order.h) and lays out a straight list of dense operations
// (schedule.h); factor() runs it. What the order takes for granted is checked by numbers:
//
//   fresh      the first factorization, and later ones whose pivots left three decades around those of the last fresh
//              one (fresh_factors.h). Bodies and groups with a pivot block that is not regular are fused and the order
//              is chosen again;
//   kept       pivots within a decade: as good as the fresh one. Beyond, every solve checks its residual and refines.
//
// Where the fresh one left rounding, and few constraints are as well eliminated after all bodies (schur.h), that is
// done in the place of the kept ones while its own pivots stay within a decade; each time that they have not, it is
// examined. To find out costs as much as it saves in a hundred solutions: it begins after so many, and ends for good
// where it served for less.
//
// Where the fresh one left more than rounding, solutions are looked at, too: all of them where it left much, else all
// until they turn out good without refinement. Where too many did not, fronts are made for numbers to stay calm in them
// (front_tree.h); if that does not help, pivot blocks are inverted no more (pivots.h); if that does not, pivots are
// chosen by masses (mass_units.h), and a little more is left than before.
//
// Where this does not lead to a trustworthy answer the same values are handed over to klu, whose word counts, singular
// included; so are all matrices without a saddle point's symmetric structure (kinematics). Each is counted, and
// helper() shows who took them.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/check.h"
#include "core/index.h"
#include "linsolve/back_ends.h"
#include "linsolve/block/factor.h"
#include "linsolve/block/fresh_factors.h"
#include "linsolve/block/fusion.h"
#include "linsolve/block/graph.h"
#include "linsolve/block/mass_units.h"
#include "linsolve/block/refinement.h"
#include "linsolve/block/schedule.h"
#include "linsolve/block/schedules.h"
#include "linsolve/block/schur.h"
#include "linsolve/condition.h"
#include "linsolve/csc_layout.h"
#include "linsolve/equilibration.h"
#include "linsolve/finite.h"

namespace poinsot::block {
namespace {

constexpr double kSymmetric = 0.9;  // share of mirrored entries: saddle points have 1, matrices of kinematics less
// Drift of pivots. Growth of rounding errors goes with it at worst: within a decade solutions lose one digit of the
// three that condition and elimination usually leave free; within three, what refinement brings back in one step.
constexpr double kNear = 10, kFar = 1e3;
// Where all else was of no use and all solutions would be refined, up to here they are good: klu's own largest along
// motions of planar loops are 2e-15 to 6e-13.
constexpr double kGoodEnough = 5e-14;
// Solutions along a motion are like one another. Where the residuals of random right sides are within what is accepted
// and those of so many solutions in a row were good, one in so many is looked at, and fewer later; both steps of two
// Newton iterations come by turns, these numbers being odd. So, too, where pivots have drifted, as long as they are not
// kLike times farther away than where the last solution was seen to be good.
constexpr double kLike = 2;
constexpr int kCalm = 8, kSeldom = 7, kLongCalm = 15 * kSeldom, kRarely = 3 * kSeldom;
// Where so many solutions needed refinement, and of those looked at one in so many, numbers that grow within the
// elimination may be the cause, or inverses of pivot blocks; to do without costs less than that refinement.
constexpr int kOften = 8, kShare = 10;
constexpr int kWorthwhile = 64;  // good solutions, after which bodies first are examined; refined ones, for masses
constexpr int kRepairs = 8;      // each fuses all that is bad at the time and costs an analysis
constexpr int kPatience = 3;     // times in a row that klu has to help before it takes over

// How solutions are made of the values at hand.
enum class Answer {
  open,         // pivots are examined at the next factorization
  trusted,      // given out unseen
  by_schur,     // the same, by bodies first
  sampled,      // the residual of each is looked at until many in a row were good, then of a few
  checked,      // the residual of each is looked at
  helped,       // by klu; the next values are tried here again
  handed_over,  // by klu, and all that follow
};

// What is done where too many solutions need refinement: one after the other, while they still do.
enum class Remedy { none, calm_fronts, substitution, by_masses, exhausted };

Answer answer(LookAt later) {
  return later == LookAt::none ? Answer::trusted : later == LookAt::some ? Answer::sampled : Answer::checked;
}

enum class BodiesFirst { unfit, unexamined, serve };

class Solver final : public LinearSolver {
 public:
  std::span<const int> slots() const override { return bodies_first() ? schur_.slots() : LinearSolver::slots(); }
  std::span<double> values() override { return bodies_first() ? schur_.values() : LinearSolver::values(); }

 private:
  LinearStatus do_analyze(Pattern&& pattern) override {
    if (LinearStatus status = layout_.build(pattern); !status.ok()) return status;
    if (LinearStatus status = layout_.matching(); !status.ok()) return status;
    const bool symmetric = symmetry(layout_) >= kSymmetric;
    bool fits = symmetric && schur_.lay_out(pattern, layout_);
    node_ = std::move(pattern.node);
    pattern = {};
    refinement_.resize();
    values_.assign(index(layout_.nonzeros()), 0);
    statistics_.nonzeros = layout_.nonzeros();
    klu_.reset();
    helped_ = 0;
    fused_.assign(index(1 + *std::ranges::max_element(node_)), -1);
    if (symmetric) fuse_with_hubs(layout_, node_, fused_);
    answer_ = symmetric && order() ? Answer::open : Answer::handed_over;
    fits = fits && answer_ == Answer::open;
    bodies_first_ = fits ? BodiesFirst::unexamined : BodiesFirst::unfit;
    if (fits) examination_.resize(layout_.n), sizes_.resize(index(layout_.n));
    slots_ = std::exchange(layout_.slots, {});
    return {};
  }

  bool order() {
    schedule_.reset();  // before another is made beside it
    const bool cheap = remedy_ == Remedy::none || by_masses();
    schedule_ = schedule_of(layout_, node_, fused_, cheap ? Fronts::cheap : Fronts::calm);
    if (!schedule_) return false;
    factor_.resize(*schedule_);
    if (remedy_ == Remedy::substitution || remedy_ == Remedy::exhausted) factor_.drop_inverses();
    statistics_.factor_nonzeros = schedule_->factor_nonzeros;
    return true;
  }

  // Along with the factorization, where that is with kept pivots.
  LinearStatus do_factor_for(Ahead ahead) override {
    if (bodies_first() || examines_bodies_first() || !examined() || refined_often()) return do_factor();
    return factor_kept(ahead);
  }

  LinearStatus do_factor() override {
    begun_ = false;
    if (bodies_first()) {
      if (schur_.factor(kNear)) {
        answer_ = Answer::by_schur;
        ++statistics_.refactorizations;
        return {};
      }
      schur_.copy_values(values_);
      answer_ = near_;  // with the schedule's pivots of before
    }
    const LinearStatus status = factor_in_order();
    if (bodies_first() || examines_bodies_first()) examine_bodies_first();
    return status;
  }
  bool examines_bodies_first() const { return bodies_first_ == BodiesFirst::unexamined && good_ >= kWorthwhile; }
  // By masses more may be left than before: it begins where it saves more than a few refinements.
  bool refined_often() const {
    return refined_ >= (remedy_ == Remedy::substitution ? kWorthwhile : kOften) && refined_ * kShare > looked_at_ &&
           remedy_ != Remedy::exhausted;
  }
  bool by_masses() const { return remedy_ == Remedy::by_masses; }
  // Whether there are pivots to keep.
  bool examined() const {
    return answer_ == Answer::trusted || answer_ == Answer::sampled || answer_ == Answer::checked;
  }

  LinearStatus factor_in_order() {
    if (answer_ == Answer::handed_over) return factor_by_klu();
    if (refined_often()) {
      looked_at_ = refined_ = 0;
      remedy_ = Remedy{static_cast<int>(remedy_) + 1};
      if (remedy_ == Remedy::substitution) {
        factor_.drop_inverses();
      } else {
        if (order()) return factor_fresh();
        answer_ = Answer::handed_over;
        return factor_by_klu();
      }
    }
    return examined() ? factor_kept() : factor_fresh();
  }

  LinearStatus factor_kept(Ahead ahead = {}) {
    const Drift drift = factor_.factor(*schedule_, values_, true, ahead.b, ahead.only && answer_ == Answer::trusted);
    if (!drift.within(kFar)) return factor_fresh();
    begun_ = !ahead.b.empty();
    ++statistics_.refactorizations;
    drift_ = drift;
    answer_ = drift.within(kNear)                                      ? near_
              : near_ != Answer::checked && drift.like(looked_, kLike) ? Answer::sampled
                                                                       : Answer::checked;
    return {};
  }

  std::uint64_t orientation() override { return answer_ == Answer::handed_over ? klu_->orientation() : 0; }
  Helper helper() const override { return {"klu", klu_.get()}; }

  LinearStatus factor_fresh() {
    if (!all_finite(values_)) return {LinearFailure::not_finite, -1, "the matrix has an entry that is not finite"};
    ++statistics_.factorizations;
    {
      Equilibration equilibration;
      equilibration.resize(layout_.n);
      (void)equilibration.find(layout_, values_);
      refinement_.measure_by(equilibration);
      if (by_masses()) by_masses_ = mass_units(layout_, values_, node_, equilibration.col());
    }
    answer_ = Answer::open;
    FreshFactors fresh(layout_, values_, factor_, refinement_, by_masses() ? by_masses_ : refinement_.rows(),
                       good_residual());
    const std::vector<int> fused = fused_;
    const Pivots first = fresh.factor(*schedule_);
    Pivots last = first;
    for (int repairs = 0; last != Pivots::good; ++repairs) {
      if (repairs == kRepairs || !fuse(layout_, node_, *schedule_, fresh.bad(), fused_) || !order()) break;
      last = fresh.factor(*schedule_);
    }
    if (last != Pivots::good && first == Pivots::doubtful) {  // repairs came to nothing better, and are undone
      fused_ = fused;
      if (order() && fresh.trustworthy(*schedule_)) last = Pivots::good;
      near_ = Answer::checked;
    } else {
      near_ = answer(fresh.look_at());
    }
    statistics_.reciprocal_condition = fresh.reciprocal_condition();
    if (!schedule_) answer_ = Answer::handed_over;
    if (last != Pivots::good) return factor_by_klu();
    answer_ = near_;
    drift_ = looked_ = {};
    good_ = 0;
    helped_ = 0;
    return {};
  }

  bool bodies_first() const { return bodies_first_ == BodiesFirst::serve; }

  // After a factorization in the usual order: whether to eliminate bodies first leaves residuals that are rounding,
  // too.
  void examine_bodies_first() {
    const bool again = bodies_first(), worthwhile = !again || by_schur_ >= kWorthwhile;
    bodies_first_ = BodiesFirst::unfit;
    by_schur_ = 0;
    if (!worthwhile || (answer_ != Answer::trusted && answer_ != Answer::sampled)) return;
    if (!again) schur_.take_values(values_);
    if (!all_finite(values_) || !schur_.choose(refinement_.rows())) return;
    (void)schur_.factor(kNear);
    double size = 0;
    const auto solve = [&](std::span<double> b) {
      refinement_.begin(b);
      schur_.solve(b);
      size = std::max(size, refinement_.residual(b));
    };
    for (std::size_t j = 0; j < sizes_.size(); ++j) sizes_[j] = refinement_.column(j);
    if (examination_.estimate(layout_, values_, solve, sizes_) >= kSingularCondition || size > kSmallResidual) return;
    bodies_first_ = BodiesFirst::serve;
    answer_ = Answer::by_schur;
  }

  LinearStatus do_solve(std::span<double> b) override {
    if (answer_ == Answer::helped || answer_ == Answer::handed_over) return klu_->solve(b);
    if (answer_ == Answer::by_schur) {
      ++by_schur_;
      schur_.solve(b);
      return {};
    }
    const bool unseen = answer_ == Answer::trusted || (answer_ == Answer::sampled && passes_unseen());
    if (!unseen) refinement_.begin(b);
    if (std::exchange(begun_, false))
      factor_.back(*schedule_, b);
    else
      solve_in_order(b);
    ++good_;
    if (unseen) return {};
    const double size = refinement_.residual(b);
    ++looked_at_;
    if (size <= good_residual()) {
      looked_ = drift_;
      return {};
    }
    good_ = 0;
    const auto again = [this](std::span<double> r) { solve_in_order(r); };
    if (size <= kLargeResidual) {  // factors that leave so little leave no more than rounding of a correction
      refinement_.correct(b, again);
      ++statistics_.refinements;
      ++refined_;
      return {};
    }
    ++refined_;
    if (refinement_.refine(b, good_residual(), statistics_.refinements, again) <= kLargeResidual) return {};
    std::ranges::copy(refinement_.b(), b.begin());
    if (LinearStatus status = factor_by_klu(); !status.ok()) return status;
    return klu_->solve(b);
  }

  bool passes_unseen() const { return good_ >= kCalm && good_ % (good_ < kLongCalm ? kSeldom : kRarely) != 0; }

  // After a solve that was to be the only one the factors are made again.
  void solve_in_order(std::span<double> b) {
    if (!factor_.kept()) {
      (void)factor_.factor(*schedule_, values_, true);
      ++statistics_.refactorizations;
    }
    factor_.solve(*schedule_, b);
  }

  double good_residual() const { return remedy_ < Remedy::by_masses ? kGoodResidual : kGoodEnough; }

  LinearStatus factor_by_klu() {
    if (!klu_) {
      klu_ = make_klu();
      Pattern columns{layout_.n, {}, node_};
      for (int j = 0; j < layout_.n; ++j)
        for (int k = layout_.start[index(j)]; k < layout_.start[index(j) + 1]; ++k)
          columns.blocks.push_back({layout_.row[index(k)], j, 1, 1});
      if (LinearStatus status = klu_->analyze(std::move(columns)); !status.ok()) return status;
    }
    ++statistics_.handed_over;
    if (answer_ != Answer::handed_over) answer_ = ++helped_ < kPatience ? Answer::helped : Answer::handed_over;
    std::ranges::copy(values_, klu_->values().begin());
    LinearStatus status = klu_->factor();
    statistics_.reciprocal_condition = klu_->statistics().reciprocal_condition;
    statistics_.factor_nonzeros = klu_->statistics().factor_nonzeros;
    return status;
  }

  CscLayout layout_;
  Remedy remedy_ = Remedy::none;
  std::vector<int> node_, fused_;
  std::shared_ptr<const Schedule> schedule_;
  Factor factor_;
  Schur schur_;
  BodiesFirst bodies_first_ = BodiesFirst::unfit;
  Condition examination_;      // of bodies first, which is to allocate nothing within a step
  std::vector<double> sizes_;  // of the unknowns, for it
  std::unique_ptr<LinearSolver> klu_;
  Refinement refinement_{layout_, values_};
  bool begun_ = false;             // the right-hand side to be solved for was eliminated with the factorization
  std::vector<double> by_masses_;  // units of rows
  Answer answer_ = Answer::open;
  Answer near_ = Answer::trusted;  // with pivots near those of the last fresh factorization, by what that one left
  Drift drift_, looked_;           // of the pivots at hand, and of those whose last solution was seen to be good
  std::int64_t good_ = 0;          // solutions since one was not, as far as was looked
  std::int64_t by_schur_ = 0;      // solutions since bodies first were examined
  std::int64_t looked_at_ = 0, refined_ = 0;  // solutions since a remedy, and those that needed refinement
  int helped_ = 0;                            // by klu, times in a row
};

}  // namespace
}  // namespace poinsot::block

std::unique_ptr<poinsot::LinearSolver> poinsot::make_block() {
  return std::make_unique<block::Solver>();
}
