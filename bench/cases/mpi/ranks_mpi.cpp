// The module that joins the ranks of an MPI job (bench/cases/ranks.h). It uses nothing of the program but that header.
#include <mpi.h>

#include <algorithm>
#include <list>
#include <utility>

#include "bench/cases/ranks.h"

namespace {

using poinsot::cases::Ranks;

class MpiRanks final : public Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }

  void broadcast(std::string& bytes) override {
    auto length = static_cast<unsigned long long>(bytes.size());
    MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
    bytes.resize(length);
    constexpr unsigned long long kPiece = 1 << 30;
    for (unsigned long long begin = 0; begin < length; begin += kPiece)
      MPI_Bcast(bytes.data() + begin, static_cast<int>(std::min(kPiece, length - begin)), MPI_BYTE, 0, MPI_COMM_WORLD);
  }

  // Two ranks may send to one another at a time, so neither waits for the other to receive.
  void send(int to, std::string_view bytes) override {
    forget_sent();
    Sent& sent = sent_.emplace_back(std::string(bytes));
    MPI_Isend(sent.bytes.data(), static_cast<int>(sent.bytes.size()), MPI_BYTE, to, 0, MPI_COMM_WORLD, &sent.request);
  }

  std::optional<Message> receive() override {
    forget_sent();
    int there = 0, size = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &status);
    if (!there) return {};
    MPI_Get_count(&status, MPI_BYTE, &size);
    Message message{status.MPI_SOURCE, std::string(static_cast<std::size_t>(size), '\0')};
    MPI_Recv(message.bytes.data(), size, MPI_BYTE, message.from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return message;
  }

  void finish() override {
    for (Sent& sent : sent_) MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
    MPI_Finalize();
  }
  void abort(int status) override { MPI_Abort(MPI_COMM_WORLD, status); }

 private:
  struct Sent {
    explicit Sent(std::string what) : bytes(std::move(what)) {}
    std::string bytes;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  void forget_sent() {
    sent_.remove_if([](Sent& sent) {
      int done = 0;
      MPI_Test(&sent.request, &done, MPI_STATUS_IGNORE);
      return done != 0;
    });
  }

  int rank_ = 0, size_ = 1;
  std::list<Sent> sent_;  // under way
};

}  // namespace

extern "C" Ranks* poinsot_join_ranks();
extern "C" Ranks* poinsot_join_ranks() {
  return new MpiRanks;
}
