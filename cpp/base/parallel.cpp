#include "base/parallel.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

namespace mortier {

/// One call of forEach, upward or downward: which items wait for which.
struct Job {
  const Threads::Work& work;
  std::vector<std::vector<int>> next;  ///< for each item, those that wait for it
  std::vector<int> waitsFor;           ///< for each item, how many it waits for
  std::deque<int> ready;
  int unfinished = 0;
  std::exception_ptr failure;
  int failed = 0;  ///< the item it is of
};

class Threads::Pool {
 public:
  explicit Pool(int others) {
    for (int i = 0; i < others; ++i) threads_.emplace_back([this] { helpUntilStopped(); });
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() {
    {
      const std::lock_guard lock(mutex_);
      stopped_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  [[nodiscard]] int count() const { return static_cast<int>(threads_.size()) + 1; }

  void run(Job& job) {
    std::unique_lock lock(mutex_);
    jobs_.push_back(&job);
    changed_.notify_all();
    while (job.unfinished > 0) {
      // A caller that has nothing left to do helps with what its items have called for.
      Job* const next = job.ready.empty() ? innermostReady(&job) : &job;
      if (next != nullptr)
        doOneItem(*next, lock);
      else
        changed_.wait(lock);
    }
    jobs_.erase(std::find(jobs_.begin(), jobs_.end(), &job));
    if (job.failure) std::rethrow_exception(job.failure);
  }

 private:
  void helpUntilStopped() {
    std::unique_lock lock(mutex_);
    while (!stopped_) {
      if (Job* const job = innermostReady(nullptr))
        doOneItem(*job, lock);
      else
        changed_.wait(lock);
    }
  }

  /// The last job with an item to do that was called for after `outer`: others wait for it. \pre the lock is
  /// held.
  [[nodiscard]] Job* innermostReady(const Job* outer) const {
    for (auto job = jobs_.rbegin(); job != jobs_.rend() && *job != outer; ++job)
      if (!(*job)->ready.empty()) return *job;
    return nullptr;
  }

  /// \pre the lock is held and an item is ready.
  void doOneItem(Job& job, std::unique_lock<std::mutex>& lock) {
    const int item = job.ready.front();
    job.ready.pop_front();
    if (!job.failure) {
      lock.unlock();
      std::exception_ptr failure;
      try {
        job.work(item);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      if (failure && (!job.failure || item < job.failed)) {
        job.failure = failure;
        job.failed = item;
      }
    }
    // What has become ready comes first: its data are at hand.
    for (const int each : job.next.empty() ? std::vector<int>{} : job.next[item])
      if (--job.waitsFor[each] == 0) job.ready.push_front(each);
    --job.unfinished;
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Job*> jobs_;
  bool stopped_ = false;
  std::vector<std::thread> threads_;
};

Threads::Threads(int count) {
  if (count > 1) pool_ = std::make_unique<Pool>(count - 1);
}

Threads::~Threads() = default;

Threads& Threads::none() {
  static Threads caller(1);
  return caller;
}

int Threads::count() const {
  return pool_ ? pool_->count() : 1;
}

void Threads::forEach(int n, const Work& work) {
  if (!pool_ || n == 1) {
    for (int i = 0; i < n; ++i) work(i);
    return;
  }
  Job job{work, {}, {}, {}, n, {}};
  for (int i = 0; i < n; ++i) job.ready.push_back(i);
  pool_->run(job);
}

void Threads::upward(const std::vector<int>& parent, const Work& work) {
  const auto n = static_cast<int>(parent.size());
  if (!pool_) {
    for (int i = 0; i < n; ++i) work(i);
    return;
  }
  Job job{work, std::vector<std::vector<int>>(n), std::vector<int>(n, 0), {}, n, {}};
  for (int i = 0; i < n; ++i)
    if (parent[i] >= 0) {
      job.next[i].push_back(parent[i]);
      ++job.waitsFor[parent[i]];
    }
  for (int i = 0; i < n; ++i)
    if (job.waitsFor[i] == 0) job.ready.push_back(i);
  pool_->run(job);
}

void Threads::downward(const std::vector<int>& parent, const Work& work) {
  const auto n = static_cast<int>(parent.size());
  if (!pool_) {
    for (int i = n; i-- > 0;) work(i);
    return;
  }
  Job job{work, std::vector<std::vector<int>>(n), std::vector<int>(n, 0), {}, n, {}};
  for (int i = n; i-- > 0;)
    if (parent[i] >= 0) {
      job.next[parent[i]].push_back(i);
      ++job.waitsFor[i];
    } else {
      job.ready.push_back(i);
    }
  pool_->run(job);
}

}  // namespace mortier
