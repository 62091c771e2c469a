#include "bench/cases/distribute.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <thread>
#include <utility>

#include "bench/study/cache.h"
#include "core/input_error.h"
#include "core/interruption.h"

namespace poinsot::cases {
namespace {

using Clock = std::chrono::steady_clock;
enum : char { kWants = 'W', kRows = 'R', kInterrupted = 'I', kBye = 'B' };
constexpr std::chrono::microseconds kPoll{1000};
constexpr std::chrono::milliseconds kChunk{50}, kSend{20};
constexpr std::size_t kMostInMessage = 4096;  // in a message

std::string packed(const CaseRow& row) {
  return fmt::format("{} {} {}", row.number, int{row.failed}, row.line);
}

// Calls take(row) for each row of a message.
template <class Take>
void unpack(std::string_view bytes, const Take& take) {
  while (!bytes.empty()) {
    const std::string_view line = bytes.substr(0, bytes.find('\n') + 1);
    CaseRow row;
    const auto number = std::from_chars(line.data(), line.data() + line.size(), row.number);
    row.failed = number.ptr[1] == '1';
    row.line = line.substr(static_cast<std::size_t>(number.ptr - line.data()) + 3);
    take(std::move(row));
    bytes.remove_prefix(line.size());
  }
}

std::string packed(const std::vector<std::int64_t>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(std::int64_t)};
}

std::vector<std::int64_t> unpack_numbers(std::string_view bytes) {
  std::vector<std::int64_t> numbers(bytes.size() / sizeof(std::int64_t));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

// What a rank has to compute and what it has computed: between its threads and the one that speaks with rank 0.
class Desk {
 public:
  std::vector<std::int64_t> take() {
    std::unique_lock lock(access_);
    came_.wait(lock, [&] { return !cases_.empty() || closed_; });
    if (cases_.empty() || interruption_requested) return {};
    const std::int64_t number = cases_.front();
    cases_.pop_front();
    return {number};
  }
  void put(const CaseRow& row) {
    const std::lock_guard lock(access_);
    rows_ += packed(row);
    ++done_;
  }
  void add(const std::vector<std::int64_t>& numbers) {
    const std::lock_guard lock(access_);
    cases_.insert(cases_.end(), numbers.begin(), numbers.end());
    came_.notify_all();
  }
  void close() {
    const std::lock_guard lock(access_);
    closed_ = true;
    came_.notify_all();
  }
  std::string rows() {
    const std::lock_guard lock(access_);
    return std::exchange(rows_, {});
  }
  std::size_t waiting() {
    const std::lock_guard lock(access_);
    return cases_.size();
  }
  std::int64_t done() {
    const std::lock_guard lock(access_);
    return done_;
  }

 private:
  std::mutex access_;
  std::condition_variable came_;
  std::deque<std::int64_t> cases_;
  std::string rows_;
  std::int64_t done_ = 0;
  bool closed_ = false;
};

}  // namespace

void share(Ranks& ranks, std::string& content) {
  const std::string own = study::program_identity();
  std::string program = own;
  ranks.broadcast(program);
  ranks.broadcast(content);
  if (program != own && !content.empty())
    throw InputError(
        fmt::format("rank {} is another program than rank 0: there {}, here {}", ranks.rank(), program, own));
}

void lead(Ranks& ranks, const Study& study, References& references, int threads, Undone& undone,
          const std::function<void(CaseRow&&)>& put, const std::function<void()>& meanwhile) {
  int others = ranks.size() - 1;
  const auto serve = [&] {
    while (const std::optional<Ranks::Message> message = ranks.receive()) {
      const char kind = message->bytes.front();
      std::string_view bytes(message->bytes);
      bytes.remove_prefix(1);
      std::size_t wanted = 0;
      if (kind == kWants) {
        std::memcpy(&wanted, bytes.data(), sizeof wanted);
        bytes.remove_prefix(sizeof wanted);
      }
      unpack(bytes, put);
      if (kind == kWants) ranks.send(message->from, packed(undone.take(wanted)));
      if (kind == kInterrupted) interruption_requested = true;
      if (kind == kBye || kind == kInterrupted) --others;
    }
    meanwhile();
  };
  run_threads(study, references, threads, {[&] { return undone.take(1); }, put, serve, kPoll});
  while (others > 0) {
    serve();
    std::this_thread::sleep_for(kPoll);
  }
}

bool follow(Ranks& ranks, const Study& study, References& references, int threads) {
  Desk desk;
  const auto began = Clock::now();
  auto sent = began;
  bool asked = false, closed = false;
  const auto say = [&](char kind, std::string_view more = {}) {
    ranks.send(0, fmt::format("{}{}{}", kind, more, desk.rows()));
    sent = Clock::now();
  };
  const auto speak = [&] {
    if (const std::optional<Ranks::Message> message = ranks.receive()) {
      asked = false;
      const std::vector<std::int64_t> numbers = unpack_numbers(message->bytes);
      desk.add(numbers);
      closed = closed || numbers.empty();
    }
    if (closed || interruption_requested) desk.close();
    // As many as take kChunk by what was measured so far.
    const std::chrono::duration<double> passed = Clock::now() - began;
    const auto rate = static_cast<double>(desk.done()) / std::max(passed.count(), 1e-3);
    const std::size_t chunk =
        std::clamp<std::size_t>(static_cast<std::size_t>(rate * std::chrono::duration<double>(kChunk).count()),
                                static_cast<std::size_t>(threads), kMostInMessage);
    if (!closed && !asked && !interruption_requested && desk.waiting() <= chunk / 2) {
      asked = true;
      say(kWants, {reinterpret_cast<const char*>(&chunk), sizeof chunk});
    } else if (Clock::now() - sent > kSend) {
      if (const std::string rows = desk.rows(); !rows.empty()) {
        ranks.send(0, fmt::format("{}{}", char{kRows}, rows));
        sent = Clock::now();
      }
    }
  };
  run_threads(study, references, threads,
              {[&] { return desk.take(); }, [&](CaseRow&& row) { desk.put(row); }, speak, kPoll});
  while (asked && !closed) {  // an answer is on its way; what it brings was not begun
    if (ranks.receive()) break;
    std::this_thread::sleep_for(kPoll);
  }
  say(interruption_requested ? kInterrupted : kBye);
  return !interruption_requested;
}

}  // namespace poinsot::cases
