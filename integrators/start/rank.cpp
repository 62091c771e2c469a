#include "integrators/start/rank.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "core/index.h"
#include "integrators/start/beside.h"
#include "integrators/start/closed_beside.h"
#include "integrators/start/doubtful_rows.h"
#include "integrators/start/few_groups.h"
#include "integrators/start/loop_rows.h"
#include "integrators/start/row_space.h"
#include "linsolve/column_dependencies.h"
#include "linsolve/separation.h"

namespace poinsot {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr std::size_t kLong = 1000;  // rows of loops: less can make them barely independent otherwise only
constexpr int kManyRows = 20'000;    // of loops: one place beside is looked at for all
constexpr int kDirections = 2;       // at random
constexpr int kClosings = 4;         // of closing it beside

class Examination {
 public:
  Examination(std::shared_ptr<const Model> model, std::span<const BodyState> states, RankNames names)
      : model_(std::move(model)), states_(states.begin(), states.end()), names_(names) {}

  RankAnalysis run() {
    const int rows = static_cast<int>(model_->rows.size());
    result_.variables = 6 * static_cast<int>(model_->bodies.size());
    result_.rank = result_.rank_here = rows;
    space_.emplace(all_rows(model_, 0, states_));
    result_.doubt = vanishing_row(*space_);
    result_.loops = loop_rows(*model_, *space_);
    if (result_.loops.empty()) return std::move(result_);
    if (result_.loops.size() < model_->rows.size()) space_->keep(result_.loops);
    here_ = few_null_vectors(space_->columns(), kIndependent, {nullptr, many_rows()});
    const auto surely = [&] {
      return few_null_vectors(space_->columns(), kDependent,
                              {names_ == RankNames::all ? &named_.emplace() : nullptr, many_rows()});
    };
    surely_ = here_.from <= kDependent ? here_ : surely();
    // Rows that are barely independent by the length of the mechanism are so wherever it stands: not singular here.
    const bool is_long = space_->rows().size() >= kLong;
    if (is_long && surely_.columns.size() + here_.stretched >= here_.columns.size()) here_ = surely_;
    if (here_.columns.empty()) {
      tell_few_digits();
      return std::move(result_);
    }
    without_ = here_.from <= kDependent ? gathered(space_->columns(), here_, kDependent) : chosen(here_);
    std::shared_ptr<FrontQr> decomposition = here_.decomposition;
    here_.decomposition = surely_.decomposition = nullptr;
    look_beside(std::move(decomposition));
    tell_few_digits();
    return std::move(result_);
  }

 private:
  // Rows of the model without which the others are as independent as can be; where there are many, just independent.
  std::vector<int> chosen(NullSpace null) const { return of_model(choose(std::move(null))); }
  static std::vector<int> choose(NullSpace null) {
    return many(null) ? std::move(null.columns) : separate(std::move(null.vectors));
  }
  // The same of few joints, of which runs set rows aside: systems of their structure are then known already.
  std::vector<int> gathered(const Sparse& columns, const NullSpace& null, double tolerance) const {
    return of_model(rows_of_few_groups(*model_, space_->rows(), columns, null, tolerance));
  }
  std::vector<int> of_model(std::vector<int> columns) const {
    for (int& column : columns) column = space_->rows()[index(column)];
    std::ranges::sort(columns);
    return columns;
  }

  bool many_rows() const { return static_cast<int>(space_->rows().size()) > kManyRows; }

  struct LookedAt {
    PlaceBeside start;
    std::optional<PlaceBeside> best;  // where the fewest rows are dependent
    std::optional<PlaceBeside> along;
    double free = kFreeBeside;  // in `best`
  };

  void look_beside(std::shared_ptr<FrontQr> decomposition) {
    const Sparse columns = space_->columns();
    beside_.emplace(model_, states_, *space_, suspects());
    const bool all_follow = many_rows() && all_follow_beside(std::move(decomposition));
    LookedAt at = all_follow ? LookedAt{} : look_each_way(columns);
    if (at.best && at.best->dependent < suspects())
      tell_what_is_singular(columns, at);
    else
      tell_what_follows(columns, at);
  }

  std::size_t suspects() const { return here_.columns.size(); }  // how many rows may be dependent
  // Conflicts are told as a reader of the scene meets them: what contradicts rows before it.
  std::vector<int> by_order(const Sparse& columns) const {
    return of_model(null_space(columns, kIndependent, space_->rows().size()).columns);
  }

  LookedAt look_each_way(const Sparse& columns) {
    LookedAt at;
    Trial trial = beside_->begin(without_, kDirections);
    if (trial.regular) result_.conflicts = conflicts(trial, *beside_, *space_);
    if (surely_.columns.empty()) result_.conflicts.clear();  // rows independent, if only just, contradict nothing
    if (!result_.conflicts.empty()) {
      std::vector<Conflict> as_chosen = std::exchange(result_.conflicts, {});
      Trial other = beside_->begin(by_order(columns));
      if (other.regular) result_.conflicts = conflicts(other, *beside_, *space_);
      if (result_.conflicts.empty()) result_.conflicts = std::move(as_chosen);
    }
    if (trial.regular && result_.conflicts.empty()) {
      at.best = at.along = beside_->along_velocities(trial);
      for (int k = 0; k < kDirections && (!at.best || at.best->dependent > 0); ++k) {
        std::optional<PlaceBeside> place = beside_->at_random(trial, k);
        if (place && (!at.best || place->dependent < at.best->dependent)) at.best = std::move(place);
      }
      if (!at.best || at.best->dependent == suspects()) look_farther(trial, at);
    }
    at.start = std::move(trial.start);
    return at;
  }

  void look_farther(Trial& trial, LookedAt& at) {
    for (int k = 0; k < kDirections; ++k) {
      std::optional<PlaceBeside> place = beside_->where_they_part(trial, k);
      if (!place) continue;
      place->dependent = dependent_columns(place->columns, kFreeFarther, suspects()).size();
      at.best = std::move(place);
      at.free = kFreeFarther;
      return;
    }
  }

  void tell_what_is_singular(const Sparse& columns, LookedAt& at) {
    NullSpace null = few_null_vectors(at.best->columns, at.free);
    const bool tried = !at.best->holds && follows_along(at);
    if (tried) at.best = at.along, null = few_null_vectors(at.along->columns, kFreeBeside);
    tell_redundant(at.best->columns, at.free, null);
    if (!at.best->holds) follow_where_all_hold();
    tell_singular(columns);
    result_.to_first_order = at.free < kFreeBeside;
    result_.moves_on = at.along && beside_->leads_on(at.start, *at.along, result_.aside);
    if (at.along) result_.time_beside = at.along->t;
  }

  void tell_what_follows(const Sparse& columns, const LookedAt& at) {
    if (surely_.columns.size() < suspects())
      result_.doubt = barely_independent_row(*space_, columns, surely_.columns, kIndependent, kDependent);
    tell_redundant(columns, kDependent, surely_);
    if (!at.along || at.along->holds || surely_.columns.size() < suspects()) return;
    Trial other = beside_->begin(by_order(columns));
    std::optional<PlaceBeside> place;
    if (other.regular) place = beside_->along_velocities(other);
    if (!place || place->holds) place = at.along;
    const auto level = place->by_rate ? Conflict::Level::later_velocity : Conflict::Level::later;
    result_.conflicts.push_back({place->worst, level, place->off, place->t});
  }

  // Whether as many rows follow and hold in one place that is beside in every way at once. Where that cannot be said,
  // who looks at each way by itself finds out why.
  bool all_follow_beside(std::shared_ptr<FrontQr> decomposition) {
    Trial trial = decomposition ? beside_->begin(std::move(decomposition)) : beside_->begin(without_, 1);
    if (!trial.regular) return false;
    if (!conflicts(trial, *beside_, *space_).empty()) return false;
    const std::optional<PlaceBeside> place = beside_->anywhere(trial);
    return place && place->dependent == here_.columns.size() && place->holds;
  }

  // Off the places where all rows hold, rows may look independent that follow there: of planar loops, those that keep
  // them in their plane. Along the velocities they hold; all is tried there that moves.
  bool follows_along(const LookedAt& at) {
    if (!at.along || !at.along->holds || at.along->dependent <= at.best->dependent) return false;
    if (at.along->dependent >= suspects()) return false;
    const NullSpace null = few_null_vectors(at.along->columns, kFreeBeside);
    return !many(null) && beside_->has_moved(at.start, *at.along, null);
  }
  // Where it does not move, positions that can be closed beside say what follows.
  void follow_where_all_hold() {
    ClosedBeside closed(*model_, states_);
    if (is_beside_ || result_.aside.empty() || !closed.can_be_found()) return;
    std::optional<RankAnalysis> least;
    for (int k = 0; k < kClosings; ++k) {
      const std::optional<std::vector<BodyState>> at = closed.next();
      if (!at) continue;
      Examination examination(model_, *at, names_);
      examination.is_beside_ = true;
      RankAnalysis found = examination.run();
      if (found.singular_position() || !found.conflicts.empty()) continue;
      if (!least || found.aside.size() < least->aside.size()) least = std::move(found);
      if (least->aside.size() <= result_.aside.size()) return;
    }
    if (!least || least->aside.size() >= suspects()) return;
    least->loops = std::move(result_.loops);
    result_ = std::move(*least);
  }

  void tell_redundant(const Sparse& columns, double tolerance, const NullSpace& null) {
    if (names_ == RankNames::all) {
      const bool known = named_ && tolerance == kDependent;
      ColumnDependencies found = known ? *std::exchange(named_, {}) : column_dependencies(columns, tolerance);
      result_.named = found.named;
      for (ColumnDependency& d : found.columns)
        result_.dependent.push_back({space_->rows()[index(d.column)], of_model(std::move(d.others))});
    }
    tell_undetermined(columns, null);
    // Beside rows that are barely independent nothing of the others' independence is to be given away.
    if (result_.doubt.part > 0 && !result_.doubt.vanishing) {
      result_.aside = chosen(null);
    } else {
      const bool known = here_.from <= kDependent && tolerance == kDependent;
      result_.aside = known ? without_ : gathered(columns, null, tolerance);
    }
    result_.aside_here = result_.aside;
    result_.rank = static_cast<int>(model_->rows.size() - result_.aside.size());
    result_.rank_here = result_.rank;
  }

  void tell_undetermined(const Sparse& columns, const NullSpace& null) {
    const auto vanishes = [&](const auto& entry) { return space_->rows()[index(entry.first)] == result_.doubt.row; };
    const bool stands_in = std::ranges::any_of(null.vectors, [&](const SparseEntries& z) {
      return result_.doubt.vanishing && std::ranges::any_of(z, vanishes);
    });
    if (stands_in) result_.doubt = {};  // others say the same
    LoadedGroups groups(*model_, *space_, states_);
    if (many(null)) groups.add_all();
    for (const SparseEntries& z : null.vectors) groups.add(columns, z);
    result_.undetermined = groups.found();
  }

  // Of the rows that are kept, those that are no more than combinations of others at the given position.
  void tell_singular(const Sparse& columns) {
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<int> kept;
    for (int k = 0; k < columns.outerSize(); ++k) {
      if (std::ranges::binary_search(result_.aside, space_->rows()[index(k)])) continue;
      for (Sparse::InnerIterator it(columns, k); it; ++it)
        entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(kept.size()), it.value());
      kept.push_back(k);
    }
    Sparse part(columns.rows(), static_cast<Eigen::Index>(kept.size()));
    part.setFromTriplets(entries.begin(), entries.end());
    const auto whole = [&](std::vector<int> some) {
      for (int& k : some) k = kept[index(k)];
      return of_model(std::move(some));
    };
    for (ColumnDependency& d : column_dependencies(part, kIndependent).columns)
      result_.singular.push_back({space_->rows()[index(kept[index(d.column)])], whole(std::move(d.others))});
    result_.aside_here.clear();
    std::ranges::set_union(result_.aside, whole(choose(few_null_vectors(part, kIndependent))),
                           std::back_inserter(result_.aside_here));
    result_.rank_here = result_.rank - static_cast<int>(result_.singular.size());
  }

  void tell_few_digits() {
    const bool redundant = !result_.aside.empty(), moves = result_.degrees_of_freedom() > 0;
    if (result_.doubt.row >= 0 || result_.singular_position() || !result_.conflicts.empty()) return;
    if (!redundant && moves) return;
    result_.doubt = row_of_few_digits(*space_, result_.aside.size());
  }

  std::shared_ptr<const Model> model_;
  std::vector<BodyState> states_;
  RankNames names_;
  bool is_beside_ = false;  // of a place where another one stands
  std::optional<RowSpace> space_;
  std::optional<Beside> beside_;
  NullSpace here_;    // of the rows at the given position, at kIndependent but for the length of the mechanism
  NullSpace surely_;  // at kDependent
  std::optional<ColumnDependencies> named_;  // of these, where names are asked for and the two differ
  std::vector<int> without_;                 // model rows: the others are independent at the given position
  RankAnalysis result_;
};

}  // namespace

std::vector<int> RankAnalysis::dependent_rows() const {
  std::vector<int> rows;
  for (const Dependency& d : dependent) rows.push_back(d.row);
  return rows;
}

RankAnalysis analyze_rank(const std::shared_ptr<const Model>& model, std::span<const BodyState> states,
                          RankNames names) {
  return Examination(model, states, names).run();
}

}  // namespace poinsot
