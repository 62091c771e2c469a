// Redundant rows that contradict those they follow from.
#pragma once

#include <string>
#include <vector>

namespace poinsot {

class Beside;
class RowSpace;
struct Trial;

// A redundant row that does not hold where those hold that it follows from.
struct Conflict {
  enum class Level { position, velocity, later, later_velocity };
  int row;
  Level level;
  double by;    // m or m/s that the bodies are off it; `later`: m, `later_velocity`: m/s, at `time`
  double time;  // s
};

std::string describe(const Conflict& conflict);  // "0.002 m (position)"

// Of the rows a trial leaves out, at its start, which becomes the one that `beside` judges by.
std::vector<Conflict> conflicts(Trial& trial, Beside& beside, RowSpace& space);

}  // namespace poinsot
