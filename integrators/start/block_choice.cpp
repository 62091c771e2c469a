#include "integrators/start/block_choice.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "core/index.h"
#include "integrators/start/grouped_rows.h"
#include "linsolve/column_dependencies.h"

namespace poinsot {
namespace {

// Coefficient at which rows are chosen anew, and as large as it may become. Two directions at right angles of which one
// is set aside have the coefficient cot α when the redundant one is α from the row that is kept in its place. Of two
// bodies that turn against one another α changes by kTurnsMost what each turns; as a rule much less: after a look by no
// more than kTurnsMore times what it changed by since the one before, but by kTurnsLittle. Error control sees what its
// steps leave of rows whose coefficients are large; in large blocks an exchange costs more than that.
constexpr double kWorn = 12, kWornForControl = 4, kWornWhereAsked = 1.5, kWorst = 40;
constexpr std::size_t kFew = 20;  // rows set aside
constexpr double kTurnsMost = 2, kTurnsLittle = 1.2, kTurnsMore = 3;
// Long steps turn bodies by as much as wears a choice out at once: what it changed by in the last one, and somewhat
// more, is left to it before the next, and a few times that to a new choice.
constexpr double kSooner = 1.6, kStays = 2.5;
constexpr double kLeastTurn = 0.05;  // rad, between two looks
constexpr std::size_t kMostCoefficients = 4'000'000;
constexpr double kMostProducts = 2e7;
constexpr double kBalanced = 1e-5;        // of a null vector: what steps leave of rows set aside, and no more
constexpr std::size_t kMostJudged = 400;  // rows kept
constexpr double kGain = 2;               // times better is a choice of clearest rows that is worth an exchange
constexpr double kSteady = 0.02, kTurnsLeast = 0.5;  // rate at the last two looks, and to reckon with below
constexpr double kForgotten = 0.8;                   // of how fast a choice has worn before
constexpr double kGrowth = 1.5;  // of a worn choice that is the best one found: then others are looked for again

double angle(double coefficient) {
  return std::atan(1 / coefficient);
}

// About the largest coefficient: half of the largest √(Σ_d c_kd²), by three sums with random signs.
double estimate(const BlockRows& rows, SparseCoefficients& kept, const std::vector<int>& left_out) {
  constexpr Eigen::Index kVectors = 3;
  if (!kept.factor(rows)) return HUGE_VAL;
  std::mt19937 random(1);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(rows.variables(), kVectors);
  for (Eigen::Index v = 0; v < kVectors; ++v)
    for (const int d : left_out) rows.add(random() % 2 == 0 ? 1.0 : -1.0, d, F.col(v));
  const Eigen::MatrixXd sums = kept.find(rows, F, 0);
  return sums.allFinite() ? std::sqrt(sums.rowwise().squaredNorm().maxCoeff() / kVectors) / 2 : HUGE_VAL;
}

}  // namespace

BlockChoice::BlockChoice(const Model& model, const RowSpace& space, std::vector<int> rows,
                         const std::vector<int>& aside, std::span<const int> turns, Steps steps)
    : rows_(space, std::move(rows)), watched_(rows_.products() <= kMostProducts), steps_(steps), worn_(kWorn) {
  std::vector<int> left_out, of_model;
  for (int k = 0; k < static_cast<int>(rows_.size()); ++k) {
    const int row = row_of(space, k);
    of_model.push_back(row);
    if (std::ranges::binary_search(aside, row)) left_out.push_back(k);
  }
  grouped_ = grouped_rows(model, turns, of_model);
  keep_others(left_out);
}

int BlockChoice::row_of(const RowSpace& space, int k) const {
  return space.rows()[index(rows_.place_in_space(k))];
}

bool BlockChoice::small() const {
  return kept_.size() <= SmallCoefficients::kMost;
}

bool BlockChoice::has_coefficients() const {
  return left_out_.size() <= kMost && left_out_.size() * kept_.size() <= kMostCoefficients;
}

void BlockChoice::keep_others(const std::vector<int>& left_out) {
  left_out_ = left_out;
  kept_ = all_but(rows_.size(), left_out);
  if (!watched_) return;
  if (small())
    small_.arrange(rows_, kept_, left_out_);
  else
    sparse_ = std::make_unique<SparseCoefficients>(rows_, kept_);
}

// Of a small block: for the rows kept; false, and 0, where these are not independent.
bool BlockChoice::find_small(int refinements) {
  if (!small_.find(rows_, C_)) {
    C_.setZero(static_cast<Eigen::Index>(kept_.size()), static_cast<Eigen::Index>(left_out_.size()));
    return false;
  }
  for (int r = 0; r < refinements; ++r)
    for (std::size_t d = 0; d < left_out_.size(); ++d) {
      Eigen::VectorXd f = Eigen::VectorXd::Zero(rows_.variables());
      rows_.add(1, left_out_[d], f);
      small_.refine(rows_, kept_, f, C_.col(static_cast<Eigen::Index>(d)));
    }
  return true;
}

// One for each row left out, from the coefficients or the factors found last; none where there are none.
std::vector<SparseEntries> BlockChoice::unit_null_vectors(int refinements) const {
  if (!small()) return sparse_->null_vectors(rows_, left_out_, refinements);
  std::vector<SparseEntries> vectors;
  for (std::size_t d = 0; d < left_out_.size(); ++d)
    vectors.push_back(unit_null_vector(kept_, C_.col(static_cast<Eigen::Index>(d)), left_out_[d]));
  return vectors;
}

double BlockChoice::least_pivot() const {
  return small() ? small_.least_pivot() : sparse_->least_pivot();
}

// Where rows kept are all but dependent their coefficients are the rounding of the Gram matrix: as much of a
// combination that vanishes may be in them as one likes, which in a singular position says nothing of other rows.
// Mechanisms have such rows wherever they stand that are long, or kept as independent but for their digits.
bool BlockChoice::clear() {
  constexpr double kLeast = kIndependent * kIndependent;
  if (kept_.size() > kMostJudged) return true;
  const bool now = least_pivot() > kLeast;
  if (!judged_) judged_ = now;
  return now || !*judged_;
}

// Off the constraints, as where a step may lead, rows set aside are no combinations of the others, and what they lack
// is in the coefficients, the more the nearer kept rows are to dependent ones.
bool BlockChoice::trusted(const std::vector<SparseEntries>& vectors) const {
  constexpr double kClear = 1e-4, kPart = 0.03;
  const double pivot = least_pivot();
  if (kept_.size() > kMostJudged || pivot > kClear || !judged_.value_or(true)) return true;
  return std::ranges::all_of(vectors, [&](const SparseEntries& z) { return left_by(z) <= kPart * std::sqrt(pivot); });
}

double BlockChoice::worst() {
  if (!small()) {
    const double about = estimate(rows_, *sparse_, left_out_);
    return std::isfinite(about) && clear() ? about : HUGE_VAL;
  }
  return find_small(0) && clear() ? C_.cwiseAbs().maxCoeff() : HUGE_VAL;
}

double BlockChoice::turn_until_worst(double rate) const {
  return std::max((angle(worst_) - angle(kWorst / kWorn * worn_)) / rate, kLeastTurn);
}

double BlockChoice::turn_until_worn() const {
  return std::max((angle(worst_) - angle(worn_)) / (kSooner * fastest_), kLeastTurn);
}

void BlockChoice::look(const RowSpace& space) {
  good_for_ = HUGE_VAL;
  if (!watched_) return;
  rows_.stand(space);
  worst_ = worst();
  good_for_ = turn_until_worst(kTurnsMost);
}

bool BlockChoice::renew(const RowSpace& space, double turned, double ahead, bool asked) {
  if (!watched_) return false;
  const double before = angle(worst_);
  look(space);
  const double change = turned > 0 ? (before - angle(worst_)) / turned : 0, soon = std::max(change, 0.0) * ahead;
  fastest_ = std::max(kForgotten * fastest_, change);
  const double change_before = std::exchange(change_, std::abs(change));
  const bool controls = steps_ == Steps::error_controlled && left_out_.size() <= kFew;
  const double limit = asked ? kWornWhereAsked : controls ? kWornForControl : kWorn;
  worn_ = std::max(limit, given_);
  const bool will_be = has_coefficients() && angle(worst_) - kSooner * soon < angle(worn_);
  if (!worn() && !will_be) {
    const double rate = std::max(change_, change_before), little = rate < kSteady ? kTurnsLeast : kTurnsLittle;
    given_ = std::min(given_, kGrowth * worst_);
    good_for_ = turn_until_worst(std::clamp(kTurnsMore * rate, little, kTurnsMost));
    if (limit < kWorn) good_for_ = std::min(good_for_, turn_until_worn());
    return false;
  }
  const double lasts = std::min(angle(limit) + kStays * soon, angle(kFlat));
  const double most = std::min(1 / std::tan(lasts), kGathered);
  const bool exchanged =
      has_coefficients() && std::isfinite(worst_) ? exchange(space, most, limit, asked) : choose_clearest(space);
  given_ = std::isfinite(worst_) ? kGrowth * worst_ : 0;
  worn_ = std::max(limit, given_);
  good_for_ = turn_until_worst(kTurnsMost);
  if (limit < kWorn) good_for_ = std::min(good_for_, turn_until_worn());
  return exchanged;
}

bool BlockChoice::exchange(const RowSpace& space, double most, double limit, bool asked) {
  std::vector<SparseEntries> vectors = unit_null_vectors(0);
  if (vectors.empty()) return false;
  if (!trusted(vectors)) return choose_clearest(space);
  std::vector<int> chosen = left_out_;
  for (SparseEntries& z : vectors) drop_nothing(z);  // what rounding leaves of coefficients far away
  if (asked)
    chosen = separate(std::move(vectors));  // of however many joints
  else
    repair(std::move(vectors), chosen, grouped_, most, std::min(limit, kGathered));
  std::ranges::sort(chosen);
  return chosen != left_out_ && take(chosen, HUGE_VAL);
}

bool BlockChoice::choose_clearest(const RowSpace& space) {
  const std::vector<int> chosen =
      clearest_dependent_columns(rows_.columns(space, all_but(rows_.size(), {})), kIndependent);
  return chosen.size() == left_out_.size() && take(chosen, worst_ / kGain);
}

// Leaves out others where no coefficient is as large as `limit` then.
bool BlockChoice::take(const std::vector<int>& chosen, double limit) {
  const std::vector<int> before = left_out_;
  keep_others(chosen);
  worst_ = worst();
  if (worst_ < limit) return true;
  keep_others(before);
  worst_ = worst();  // with the coefficients and factors that go with it
  return false;
}

void BlockChoice::add_aside(const RowSpace& space, std::vector<int>& rows) const {
  for (const int k : left_out_) rows.push_back(row_of(space, k));
}

// What f, the rows left out with these forces, is in terms of those kept.
Eigen::VectorXd BlockChoice::small_shares(const Eigen::VectorXd& f, const Eigen::VectorXd& forces) {
  Eigen::VectorXd shares = C_ * forces;
  small_.refine(rows_, kept_, f, shares);
  return shares;
}

void BlockChoice::carry_over(const RowSpace& space, std::span<double> lambda) {
  const auto at = [&](int k) -> double& { return lambda[index(row_of(space, k))]; };
  const auto length = [&](int k) { return space.lengths()[index(rows_.place_in_space(k))]; };
  Eigen::VectorXd f = Eigen::VectorXd::Zero(rows_.variables());
  Eigen::VectorXd forces(static_cast<Eigen::Index>(left_out_.size()));
  for (std::size_t d = 0; d < left_out_.size(); ++d) {
    const double force = std::exchange(at(left_out_[d]), 0.0) * length(left_out_[d]);
    forces[static_cast<Eigen::Index>(d)] = force;
    rows_.add(force, left_out_[d], f);
  }
  const Eigen::VectorXd shares = small() ? small_shares(f, forces) : Eigen::VectorXd(sparse_->find(rows_, f, 1));
  for (std::size_t k = 0; k < kept_.size(); ++k)
    at(kept_[k]) += shares[static_cast<Eigen::Index>(k)] / length(kept_[k]);
}

bool BlockChoice::has_null_vectors() const {
  return watched_ && left_out_.size() <= kMostNull && has_coefficients();
}

// Coefficients are those of least squares, whether or not the row left out is a combination of those kept.
bool BlockChoice::balances(const SparseEntries& z) const {
  return left_by(z) <= kBalanced * largest(z);
}
double BlockChoice::left_by(const SparseEntries& z) const {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(rows_.variables());
  for (const auto& [k, value] : z) rows_.add(value, k, load);
  return load.cwiseAbs().maxCoeff();
}

void BlockChoice::add_null_vectors(const RowSpace& space, std::vector<SparseEntries>& vectors) {
  if (!has_null_vectors()) return;
  rows_.stand(space);
  if (small() ? !find_small(1) : !sparse_->factor(rows_)) return;
  std::vector<SparseEntries> found = unit_null_vectors(1);
  if (!std::ranges::all_of(found, [&](const SparseEntries& z) { return balances(z); })) return;
  for (SparseEntries& z : found) {
    for (auto& [k, value] : z) {
      value /= space.lengths()[index(rows_.place_in_space(k))];
      k = row_of(space, k);
    }
    vectors.push_back(std::move(z));
  }
}

}  // namespace poinsot
