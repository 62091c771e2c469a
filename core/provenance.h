// Where numbers come from: the program's version and commit, how it was compiled, with which libraries, on what it
// runs. Every run record and every table's foot carries it.
#pragma once

#include <string>
#include <vector>

namespace poinsot {

struct Library {
  std::string name;
  std::string version;
};

struct Provenance {
  std::string version;             // of the program, "0.1.0"
  std::string commit;              // 40 hexadecimal digits; "unknown" when built outside a git checkout
  bool dirty = false;              // the checkout differed from the commit, untracked files included
  std::string compiler;            // "GNU 12.2.0"
  std::string flags;               // all compiler flags of this build that bear on the code, "-O3 -DNDEBUG ..."
  std::string build_type;          // "Release"
  std::vector<Library> libraries;  // as compiled against; BLAS as loaded
};

const Provenance& provenance();

// The processor's model name; "unknown" where the system does not tell.
std::string processor();

}  // namespace poinsot
