// SPDX-License-Identifier: MIT
// The described controller on the road with the solver of the write-ups, CppAD and Ipopt, whose own time adds
// to the latency as it did there: the answer to telemetry comes when it is solved, then 100 ms of sleep, and
// the next telemetry after that. Solve times are measured once and kept; runs that are given them are the
// same bit for bit.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "chicane/controller/cubic_mpc.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/run/closed_loop.hpp"
#include "problems/cpu_time.hpp"
#include "stack/cppad_solver.hpp"

namespace chicane::bench {
namespace {

constexpr double kSleep = 0.1;        // [s] before each answer, as the write-ups have it
constexpr double kTelemetry = 0.02;   // [s] until the next telemetry: the control period of the loop
constexpr double kMostLatency = 0.5;  // [s] range of latency_ms
constexpr const char* kUsage =
    "chicane-stack: the described controller on the road, with the time of its solver as latency\n\n"
    "  --preset NAME      a preset of `cubic-mpc` [weighted]\n"
    "  --set KEY=VALUE    a setting, as `chicane drive` takes it; repeatable\n"
    "  --solver NAME      cppad (CppAD and Ipopt, as the write-ups have them) or own [cppad]\n"
    "  --record FILE      measures the solve times of a run [s, one a line], and then drives with them\n"
    "  --times FILE       drives with the times of a file, from the first again when they are used up\n\n"
    "  chicane-stack --preset weighted --record times.txt\n";

struct Arguments {
  protocol::Request request;
  std::string solver = "cppad", record, times;
};

/// A solver whose solves are timed.
class TimedSolver final : public controller::CubicSolver {
 public:
  /// `last` gets the processor time of each solve [s]; it outlives the solver.
  TimedSolver(std::unique_ptr<controller::CubicSolver> inner, double& last)
      : inner_{std::move(inner)}, last_{last} {}

  solver::SolveReport solve(const controller::CubicProblem& problem,
                            const controller::CubicProblem::State& start, controller::CubicTrajectory& answer,
                            Deadline deadline) noexcept override {
    last_ = 0.0;
    const Stopwatch stopwatch(last_);
    return inner_->solve(problem, start, answer, deadline);
  }
  [[nodiscard]] std::unique_ptr<controller::CubicSolver> copy() const override {
    return std::make_unique<TimedSolver>(inner_->copy(), last_);
  }

 private:
  std::unique_ptr<controller::CubicSolver> inner_;
  double& last_;
};

/// Answers to telemetry at the times of the write-ups: while it solves and sleeps, the answer before holds.
class SleepingController final : public controller::Controller {
 public:
  SleepingController(std::unique_ptr<controller::Controller> inner, const double& solve_time,
                     std::vector<double>& times, bool is_recording)
      : inner_{std::move(inner)}, solve_time_{solve_time}, times_{times}, is_recording_{is_recording} {}

  const controller::StepResult& step(const model::Measurement& now, Deadline deadline) noexcept override {
    if (now.time < busy_until_ - 1e-9) return *result_;
    result_ = &inner_->step(now, deadline);
    if (is_recording_) times_.push_back(solve_time_);
    busy_until_ = now.time + time_of(solves_) + kSleep;
    ++solves_;
    if (result_->answer == controller::Answer::kNone) ++failures_;
    return *result_;
  }
  void reset() noexcept override {
    inner_->reset();
    busy_until_ = 0.0;
  }
  [[nodiscard]] std::string_view name() const noexcept override { return inner_->name(); }

  /// What telemetry at `time` would be answered with: the latency of the command [s]; none while it is busy.
  /// While times are recorded, that of the solve before.
  [[nodiscard]] std::optional<double> latency_at(double time) const noexcept {
    if (time < busy_until_ - 1e-9) return std::nullopt;
    const std::size_t known = is_recording_ && solves_ > 0 ? solves_ - 1 : solves_;
    return std::min(kSleep + time_of(known), kMostLatency);
  }
  [[nodiscard]] std::size_t solves() const noexcept { return solves_; }
  [[nodiscard]] std::size_t failures() const noexcept { return failures_; }

 private:
  [[nodiscard]] double time_of(std::size_t solve) const noexcept {
    return times_.empty() ? 0.0 : times_[solve % times_.size()];
  }

  std::unique_ptr<controller::Controller> inner_;
  const double& solve_time_;  ///< of the last solve [s]
  std::vector<double>& times_;
  bool is_recording_;
  const controller::StepResult* result_ = nullptr;
  double busy_until_ = 0.0;
  std::size_t solves_ = 0, failures_ = 0;
};

struct Driven {
  telemetry::RunSummary run;
  std::size_t solves = 0, failures = 0;
};

/// One run; `times` are used, or filled.
Result<Driven> drive(const scenario::Scenario& scenario, const std::string& solver,
                     std::vector<double>& times, bool is_recording) {
  SleepingController* driver = nullptr;
  double solve_time = 0.0;
  const auto make = [&](const scenario::Scenario& of) -> Result<std::unique_ptr<controller::Controller>> {
    auto timed = std::make_unique<TimedSolver>(
        solver == "own" ? controller::make_cubic_solver() : make_cppad_solver(), solve_time);
    auto inner = controller::make_cubic_mpc_with(std::get<controller::CubicMpcOptions>(of.controllers),
                                                 of.vehicle, std::move(timed));
    if (!inner) return fail(inner.error());
    auto made = std::make_unique<SleepingController>(std::move(*inner), solve_time, times, is_recording);
    driver = made.get();
    return made;
  };
  const auto loop = run::ClosedLoop::create(scenario, make);
  if (!loop) return fail(loop.error());
  while (!(*loop)->is_over()) {
    const auto latency = (*loop)->is_control_due() ? driver->latency_at((*loop)->time()) : std::nullopt;
    if (latency)
      (*loop)->apply(telemetry::Change{.name = "latency_ms", .value = fmt::format("{}", 1e3 * *latency)});
    (*loop)->advance();
  }
  return Driven{(*loop)->summary(), driver->solves(), driver->failures()};
}

Result<std::vector<double>> read_times(const std::string& file) {
  std::ifstream in(file);
  std::vector<double> times;
  for (double time = 0.0; in >> time;) times.push_back(std::clamp(time, 0.0, 10.0));
  if (times.empty())
    return fail(ErrorCode::kNotFound, fmt::format("{}: got no solve times, expected one a line", file));
  return times;
}

Result<Arguments> arguments_of(int count, char** words) {
  Arguments given;
  given.request.settings = {{"preset", "weighted"}, {"laps", "3"}, {"guard.mode", "off"}};
  for (int i = 1; i < count; i += 2) {
    const std::string word = words[i];
    const std::string value = i + 1 < count ? words[i + 1] : "";
    const std::size_t equals = value.find('=');
    if (word == "--preset") {
      given.request.settings.front().second = value;
    } else if (word == "--set" && equals != std::string::npos) {
      given.request.settings.emplace_back(value.substr(0, equals), value.substr(equals + 1));
    } else if (word == "--solver" && (value == "cppad" || value == "own")) {
      given.solver = value;
    } else if (word == "--record" && !value.empty()) {
      given.record = value;
    } else if (word == "--times" && !value.empty()) {
      given.times = value;
    } else {
      return fail(ErrorCode::kInvalidArgument, fmt::format("got {} {}\n\n{}", word, value, kUsage));
    }
  }
  if (given.record.empty() == given.times.empty())
    return fail(ErrorCode::kInvalidArgument, fmt::format("expected --record or --times\n\n{}", kUsage));
  given.request.settings.emplace_back("control_period_ms", fmt::format("{}", 1e3 * kTelemetry));
  return given;
}

void print(const Arguments& given, const Driven& driven, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const telemetry::RunSummary& run = driven.run;
  fmt::print(
      "{{\"preset\":\"{}\",\"solver\":\"{}\",\"solves\":{},\"not_solved\":{},\"solve_ms_median\":{:.3f},"
      "\"solve_ms_most\":{:.3f},\"completed\":{},\"off_track_events\":{},\"laps\":{},\"lap_time_s\":{:.2f},"
      "\"mean_speed_mps\":{:.2f},\"rms_lateral_error_m\":{:.3f},\"min_edge_distance_m\":{:.2f},"
      "\"state_hash\":\"{:016x}\"}}\n",
      run.preset, given.solver, driven.solves, driven.failures, 1e3 * times[times.size() / 2],
      1e3 * times.back(), run.completed, run.off_track_events, run.laps.size(),
      run.laps.empty() ? 0.0 : run.laps.back().lap_time, run.total.mean_speed, run.total.rms_lateral_error,
      run.total.min_edge_distance, run.state_hash);
}

int refuse(const Error& error, int code) {
  fmt::print(stderr, "chicane-stack: {}\n", error.message);
  return code;
}

int run_program(int count, char** words) {
  const Result<Arguments> given = arguments_of(count, words);
  if (!given) return refuse(given.error(), 2);
  const auto scenario = protocol::compose(given->request);
  if (!scenario) return refuse(scenario.error(), 2);
  std::vector<double> times;
  if (!given->times.empty()) {
    Result<std::vector<double>> read = read_times(given->times);
    if (!read) return refuse(read.error(), 3);
    times = std::move(*read);
  } else {
    if (const auto recorded = drive(*scenario, given->solver, times, true); !recorded)
      return refuse(recorded.error(), 2);
    std::ofstream out(given->record);
    for (const double time : times) out << fmt::format("{:.7f}\n", time);
    out.close();
    if (!out) return refuse({ErrorCode::kIo, given->record + ": cannot be written"}, 3);
    times = read_times(given->record).value_or(times);  // what a later run reads, to the last bit
  }
  const Result<Driven> driven = drive(*scenario, given->solver, times, false);
  if (!driven) return refuse(driven.error(), 2);
  print(*given, *driven, times);
  return telemetry::completed_on_road(driven->run) ? 0 : 1;
}

}  // namespace
}  // namespace chicane::bench

int main(int count, char** words) { return chicane::bench::run_program(count, words); }
