#include "recorded_threads.h"

#include <algorithm>
#include <ctime>
#include <deque>
#include <queue>
#include <utility>

#include "base/parallel.h"

namespace mortier {
namespace bench {
namespace {

double processorTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

class Record {
 public:
  void begin() {
    pieces_.assign(1, {});
    depth_ = 0;
    since_ = processorTime();
  }

  std::vector<Piece> take() {
    stop();
    return std::exchange(pieces_, std::vector<Piece>(1));
  }

  /// The items of a call; waitsFor[i]: items before i that it waits for.
  template <class Each, class Before>
  void call(const Each& inOrder, const Before& waitsFor, const Threads::Work& work) {
    const int fork = stop();
    ++depth_;
    std::vector<std::pair<int, int>> lastOf;  // item, its last piece
    std::vector<int> last;
    for (const int item : inOrder) {
      if (static_cast<size_t>(item) >= last.size()) last.resize(item + 1, -1);
      std::vector<int> before = waitsFor(item);
      for (int& each : before) each = last[each];
      if (before.empty()) before.push_back(fork);
      start(before);
      work(item);
      last[item] = stop();
    }
    --depth_;
    std::vector<int> ends{fork};
    for (const int each : last)
      if (each >= 0 && pieces_[each].next.empty()) ends.push_back(each);
    start(ends);
  }

 private:
  /// Ends the piece under way.
  int stop() {
    pieces_.back().seconds = processorTime() - since_;
    return static_cast<int>(pieces_.size()) - 1;
  }

  void start(const std::vector<int>& before) {
    const auto self = static_cast<int>(pieces_.size());
    for (const int each : before) pieces_[each].next.push_back(self);
    pieces_.emplace_back().parallel = depth_ > 0;
    since_ = processorTime();
  }

  std::vector<Piece> pieces_{1};
  int depth_ = 0;
  double since_ = 0;
};

Record record;

}  // namespace

void beginRecord() {
  record.begin();
}

std::vector<Piece> takeRecord() {
  return record.take();
}

double secondsOn(const std::vector<Piece>& pieces, int processors) {
  std::vector<int> waits(pieces.size(), 0);
  for (const Piece& piece : pieces)
    for (const int each : piece.next) ++waits[each];
  std::deque<int> ready{0};
  using Ending = std::pair<double, int>;
  std::priority_queue<Ending, std::vector<Ending>, std::greater<>> running;
  double time = 0;
  while (!ready.empty() || !running.empty()) {
    while (!ready.empty() && static_cast<int>(running.size()) < processors) {
      running.emplace(time + pieces[ready.front()].seconds, ready.front());
      ready.pop_front();
    }
    const auto [end, piece] = running.top();
    running.pop();
    time = end;
    for (const int each : pieces[piece].next)
      if (--waits[each] == 0) ready.push_front(each);
  }
  return time;
}

std::vector<int> longestChain(const std::vector<Piece>& pieces) {
  std::vector<double> begins(pieces.size(), 0);
  std::vector<int> before(pieces.size(), -1);
  double end = -1;
  int last = -1;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const double ends = begins[i] + pieces[i].seconds;
    if (ends > end) last = static_cast<int>(i);
    end = std::max(end, ends);
    for (const int each : pieces[i].next)
      if (before[each] < 0 || ends > begins[each]) {
        begins[each] = ends;
        before[each] = static_cast<int>(i);
      }
  }
  std::vector<int> chain;
  for (int i = last; i >= 0; i = before[i]) chain.push_back(i);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

}  // namespace bench

class Threads::Pool {};

Threads::Threads(int /*count*/) {}
Threads::~Threads() = default;

Threads& Threads::none() {
  static Threads caller(1);
  return caller;
}

int Threads::count() const {
  return 2;
}

void Threads::forEach(int n, const Work& work) {
  std::vector<int> all(n);
  for (int i = 0; i < n; ++i) all[i] = i;
  bench::record.call(
      all, [](int) { return std::vector<int>{}; }, work);
}

void Threads::upward(const std::vector<int>& parent, const Work& work) {
  const auto n = static_cast<int>(parent.size());
  std::vector<std::vector<int>> children(n);
  std::vector<int> all(n);
  for (int i = 0; i < n; ++i) {
    all[i] = i;
    if (parent[i] >= 0) children[parent[i]].push_back(i);
  }
  bench::record.call(
      all, [&](int i) { return children[i]; }, work);
}

void Threads::downward(const std::vector<int>& parent, const Work& work) {
  const auto n = static_cast<int>(parent.size());
  std::vector<int> all(n);
  for (int i = 0; i < n; ++i) all[i] = n - 1 - i;
  bench::record.call(
      all, [&](int i) { return parent[i] < 0 ? std::vector<int>{} : std::vector<int>{parent[i]}; }, work);
}

}  // namespace mortier
