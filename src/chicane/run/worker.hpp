// SPDX-License-Identifier: MIT
// Threads of low priority beside a run: Worker repeats one task, NewestTask answers the newest request.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace chicane::run {

/// Thread of low priority that repeats one kind of work beside a run. Control and network never wait for it.
class Worker {
 public:
  using Period = std::optional<std::chrono::milliseconds>;

  /// `work` is called on the thread after each wake(), and once each `period`, if there is one. Calls of
  /// wake() during `work` lead to one more call. Keep a Worker as the last member: its thread uses the
  /// others.
  explicit Worker(std::function<void()> work, Period period = {});
  /// Waits until a running `work` returns.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Wakes the thread and does not wait. Any thread.
  void wake();

 private:
  void run();

  std::function<void()> work_;
  Period period_;
  std::mutex mutex_;                 ///< guards all below
  std::condition_variable changed_;  ///< notified when a flag below is set
  bool is_awake_ = false;            ///< wake() was called since the last work
  bool is_ending_ = false;           ///< the destructor waits for the thread
  std::thread thread_;               ///< last member: it starts when all others are constructed
};

/// Computes the answer to the newest of several requests on a thread of low priority; callers do not wait. A
/// newer request replaces a waiting one, and cancels a running one, whose answer is discarded.
template <class Request, class Answer>
class NewestTask {
 public:
  /// Computes an answer. `is_wanted` returns false once this answer will be discarded.
  using Compute = std::function<Answer(Request request, const std::function<bool()>& is_wanted)>;
  using OnAnswer = std::function<void(const Answer&)>;

  /// Both are called on the worker's thread. `on_answer` gets each answer that is still wanted, and must not
  /// call this object.
  explicit NewestTask(Compute compute, OnAnswer on_answer = {})
      : compute_{std::move(compute)}, on_answer_{std::move(on_answer)}, worker_{[this] { work(); }} {}
  /// Cancels, and waits for the thread.
  ~NewestTask() { cancel(); }
  NewestTask(const NewestTask&) = delete;
  NewestTask& operator=(const NewestTask&) = delete;

  /// Begins a request, replacing an earlier one. Any thread, as for all functions below.
  void begin(Request request) {
    const std::lock_guard lock(mutex_);
    request_ = std::move(request);
    answer_.reset();
    ++newest_;
    worker_.wake();
  }
  /// Drops request and answer. `on_answer` is not called afterwards; waits at most for a running call of it.
  void cancel() {
    const std::lock_guard lock(mutex_);
    request_.reset();
    answer_.reset();
    ++newest_;
  }
  /// Answer to the newest request, returned once; none while it is computed, and without a request.
  [[nodiscard]] std::optional<Answer> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(answer_, std::nullopt);
  }
  /// Whether a request waits for its answer.
  [[nodiscard]] bool is_computing() const {
    const std::lock_guard lock(mutex_);
    return request_ || (computed_ > 0 && computed_ == newest_);
  }

 private:
  /// Computes the waiting request, on the worker's thread.
  void work() {
    std::unique_lock lock(mutex_);
    if (!request_) return;
    Request request = *std::exchange(request_, std::nullopt);
    const std::uint64_t number = computed_ = newest_;
    lock.unlock();
    Answer answer = compute_(std::move(request), [this, number] { return number == newest_; });
    lock.lock();
    computed_ = 0;
    if (number != newest_) return;
    if (on_answer_) on_answer_(answer);
    answer_ = std::move(answer);
  }

  Compute compute_;
  OnAnswer on_answer_;
  mutable std::mutex mutex_;              ///< guards all below
  std::optional<Request> request_;        ///< request that waits for its computation
  std::atomic<std::uint64_t> newest_{0};  ///< number of the last request; read without the mutex
  std::uint64_t computed_ = 0;            ///< number of the request that is being computed; 0: none
  std::optional<Answer> answer_;          ///< answer that take() has not returned
  Worker worker_;                         ///< last member: its thread uses the others
};

}  // namespace chicane::run
