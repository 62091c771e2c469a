// Whether the motion keeps the energy of what nothing drives or damps (core/conserved_energy.h).
//
// What steps take from a motion or add to it, each so little that nothing shows, adds up over many of them. Where
// T + V, V of gravity, springs and forces that stay, is constant, it shows at the end: there it is set beside that of
// the start, by mechanism, and told where they differ by more than 6 % of the largest kinetic energy on the way, 3 % of
// speeds. Where dampers take of it, it is told where it has become more all the same. Of other mechanisms nothing is
// known in this way, and nothing is looked at.
//
// What a step invents the next ones may take again, when it has led over a hill that the motion could not climb. So the
// same is looked at some hundred times on the way: beside the start, and where dampers take, beside the least before.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/conserved_energy.h"
#include "integrators/integrator.h"
#include "integrators/stepping/parts.h"

namespace poinsot {

class EnergyBalance {
 public:
  explicit EnergyBalance(const Problem& problem);

  bool none() const { return none_; }
  // Whether it knows of a mechanism what was lost, so that nobody else needs to guess.
  bool covers(std::size_t mechanism) const { return of_[mechanism].fate == EnergyFate::kept; }

  // The first sample.
  void begin(const Sample& start, int order);
  // Whether the step that was done is looked at: swings that are followed do not hide their largest kinetic energy in
  // between. Now and then it is one step more, or swings of so many would always be seen at the same place.
  bool due() {
    constexpr int kApart = 4, kLooks = 4, kEach = 32;
    ++steps_;
    if (steps_ <= kEach) return steps_ >= kApart;
    if (++since_ < kApart) return false;
    looks_ = (looks_ + 1) % kLooks;
    since_ = looks_ == 0 ? -1 : 0;
    return true;
  }
  // Its end, where the problem stands. Allocates nothing.
  void look(const Problem& problem, double t, const Eigen::VectorXd& v);
  // The last sample; or where a run ended before, and why may be that its motion had become another one.
  void end(const Sample& end);
  // By how much it differs, for the statistics, and said where it does too much.
  void conclude(const Run& run, const IntegratorEntry& integrator) const;

 private:
  struct Mechanism {
    EnergyFate fate = EnergyFate::unknown;
    double first = 0, last = 0;  // J, T + V
    double now = 0, least = 0;   // J, on the way, and so far
    double most_off = 0;         // J, on the way
    double t_off = 0;            // s, when
    double kinetic = 0;          // J, now
    double most_kinetic = 0;     // J
    double loads = 0;            // N, of gravity and springs; or N m
    double rounding = 0;         // J, of the energies' parts
    double mass = 0;             // kg
  };
  static constexpr double kTold = 0.06;  // of the kinetic energy
  // A step of first order is half of one late: under a constant force from rest this makes 1/n of the energy in n
  // steps, which is not lost.
  static constexpr double kLate = 2.5;

  void add_energies(const Problem& problem, double t, double Mechanism::*sum, double part = 0);
  void look_on_the_way(const Problem& problem, double t);
  double noise(const Mechanism& of, const Run& run) const;
  bool tell_at_end(const Run& run, const IntegratorEntry& integrator) const;
  void tell_on_the_way(const Run& run, const IntegratorEntry& integrator) const;
  static std::string remedy(const Settings& settings, const IntegratorEntry& integrator, double share);

  const Parts parts_;
  std::vector<Mechanism> of_;
  int order_ = 0;                // of the method
  std::vector<double> x_first_;  // of springs and torsion springs, from where laws have done work
  Eigen::VectorXd momentum_, no_accelerations_;
  std::vector<BodyState> bodies_;
  bool none_ = true, ended_ = false;
  int since_ = 0;  // steps
  int looks_ = 0;
  std::int64_t steps_ = 0;
  int energies_ = 0, apart_ = 1, until_ = 1;  // looks at energies; by how many they are apart, and the next is away
};

}  // namespace poinsot
