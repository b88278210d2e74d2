// SPDX-License-Identifier: MIT
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

/// A thread beside a run that does one kind of work again and again, behind everything else: control and
/// network never wait for it.
class Worker {
 public:
  using Period = std::optional<std::chrono::milliseconds>;

  /// `work` is called on the thread: after each wake(), and each `period` where there is one. Several calls
  /// of wake() during a work lead to one more. Owners keep a Worker as their last member: its thread uses
  /// the others.
  explicit Worker(std::function<void()> work, Period period = {});
  /// Waits for a work under way: owners end a long one before.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Wakes the thread and does not wait. Any thread.
  void wake();

 private:
  void run();

  std::function<void()> work_;
  Period period_;
  std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  bool is_awake_ = false;
  bool is_ending_ = false;
  std::thread thread_;  // last: it starts when everything else is there
};

/// Computes the answer to the newest of several requests, on a thread of its own with low priority; callers
/// do not wait. A newer request replaces one that waits, and cancels one that is being computed, whose answer
/// is discarded.
template <class Request, class Answer>
class NewestTask {
 public:
  /// `is_wanted`: false once this answer is discarded.
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
  /// Drops request and answer; `on_answer` is not called any more. Waits for a call under way at most.
  void cancel() {
    const std::lock_guard lock(mutex_);
    request_.reset();
    answer_.reset();
    ++newest_;
  }
  /// The answer to the newest request, once; none while it is computed, and when there is none.
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
  mutable std::mutex mutex_;  ///< guards all below
  std::optional<Request> request_;
  std::atomic<std::uint64_t> newest_{0};  ///< number of the last request; read without the mutex
  std::uint64_t computed_ = 0;            ///< number of the request that is being computed; 0: none
  std::optional<Answer> answer_;
  Worker worker_;  // last
};

}  // namespace chicane::run
