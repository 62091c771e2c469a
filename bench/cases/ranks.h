// Processes started together by mpirun, srun or the like: bytes from one to another.
//
// MPI stands in a module of its own (ranks_mpi.cpp), which is loaded where a launcher started the program and nowhere
// else: a plain run needs no MPI and spends nothing on it. Only one thread of a process may call these.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace poinsot::cases {

class Ranks {
 public:
  struct Message {
    int from = 0;
    std::string bytes;
  };

  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual void broadcast(std::string& bytes) = 0;  // from rank 0 to all
  virtual void send(int to, std::string_view bytes) = 0;
  virtual std::optional<Message> receive() = 0;  // nothing: none is there
  virtual void finish() = 0;                     // all are done; nothing is called after it
  virtual void abort(int status) = 0;            // ends all of them at once
};

// Whether a launcher started this process beside others, or says so.
bool started_by_launcher();
// Its place among them, by what the launcher tells; one that tells nothing of others has started it alone.
struct Launched {
  int rank = 0, processes = 1;
};
Launched launched();
// Joins the others. Throws InputError where the program was built without MPI or its module cannot be loaded.
std::unique_ptr<Ranks> join_ranks();

}  // namespace poinsot::cases
