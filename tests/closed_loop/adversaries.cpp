// SPDX-License-Identifier: MIT
#include "closed_loop/adversaries.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace chicane::attack {
namespace {

using controller::Answer;
using controller::StepResult;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kHuge = 1e308;          // finite, and so large that a product of it is not
constexpr double kStands = 0.3;          // [m/s] slower than this a car counts as standing
constexpr double kCreepingSpeed = 3.0;   // [m/s] of a car that approaches the edge slowly
constexpr double kSmallOffset = 0.02;    // [rad] steering that leaves a lane of 7 m within seconds at 20 m/s
constexpr double kSwervingGrowth = 0.1;  // [rad/s] of the swerving's amplitude

/// A command without a plan.
void command_alone(StepResult& answer, double steer, double throttle) {
  answer.answer = Answer::kDrive;
  answer.plan.size = answer.plan.reference_size = 0;
  answer.command = {.steer = steer, .throttle = throttle};
}

/// A number that a broken program may produce.
double bad_number(Random& random) {
  constexpr std::array kBad{
      kNan, kInfinity, -kInfinity, kHuge, -kHuge, std::numeric_limits<double>::denorm_min(), -0.0, 1e9};
  return kBad[random.bits() % kBad.size()];
}

model::Command random_command(AttackCycle& cycle) {
  return {.steer = cycle.random.uniform(-cycle.lock, cycle.lock),
          .throttle = cycle.random.uniform(-1.0, 1.0)};
}

/// Draws a new command when the one that is held has ended.
const model::Command& held_command(AttackCycle& cycle) {
  if (cycle.now.time >= cycle.memory.until) {
    cycle.memory.command = random_command(cycle);
    cycle.memory.until = cycle.now.time + cycle.random.uniform(0.2, 3.0);
  }
  return cycle.memory.command;
}

bool is_first_half(const AttackCycle& cycle, double period) {
  return std::fmod(cycle.since, period) < 0.5 * period;
}

void straight_on(AttackCycle&, StepResult& answer) { command_alone(answer, 0.0, 1.0); }

void lock(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * cycle.lock, 1.0);
}

void random(AttackCycle& cycle, StepResult& answer) {
  const model::Command drawn = random_command(cycle);
  command_alone(answer, drawn.steer, 1.0);
}

void random_hold(AttackCycle& cycle, StepResult& answer) {
  const model::Command held = held_command(cycle);
  command_alone(answer, held.steer, held.throttle);
}

void bang_bang(AttackCycle& cycle, StepResult& answer) {
  const double side = is_first_half(cycle, cycle.memory.pace) ? 1.0 : -1.0;
  command_alone(answer, side * cycle.memory.side * cycle.lock, 1.0);
}

void full_throttle(AttackCycle&, StepResult& answer) { answer.command.throttle = 1.0; }

void full_throttle_without_plan(AttackCycle&, StepResult& answer) {
  command_alone(answer, answer.command.steer, 1.0);
}

void hold(AttackCycle& cycle, StepResult& answer) {
  if (!cycle.memory.answer) cycle.memory.answer = answer;
  command_alone(answer, cycle.memory.answer->command.steer, cycle.memory.answer->command.throttle);
}

void frozen_output(AttackCycle& cycle, StepResult& answer) {
  if (!cycle.memory.answer) cycle.memory.answer = answer;
  answer = *cycle.memory.answer;
}

void creep(AttackCycle& cycle, StepResult& answer) {
  const double wanted = kCreepingSpeed - cycle.now.speed;
  command_alone(answer, answer.command.steer + cycle.memory.side * 4.0 * kSmallOffset,
                std::clamp(0.3 * wanted, -0.1, 0.3));
}

void drift(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, answer.command.steer + cycle.memory.side * cycle.memory.pace * kSmallOffset,
                answer.command.throttle);
}

void swerve(AttackCycle& cycle, StepResult& answer) {
  const double amplitude = std::min(kSwervingGrowth * cycle.since, cycle.lock);
  command_alone(answer,
                answer.command.steer + amplitude * std::sin(cycle.since * kTwoPi / (2.0 * cycle.memory.pace)),
                answer.command.throttle);
}

void brake(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * cycle.lock, -1.0);
}

/// Brakes to standstill along the road, and goes on braking with the wheel turned.
void reverse_gear(AttackCycle& cycle, StepResult& answer) {
  cycle.memory.has_stood = cycle.memory.has_stood || cycle.now.speed < kStands;
  const double steer = cycle.memory.has_stood ? cycle.memory.side * cycle.lock : answer.command.steer;
  command_alone(answer, steer, cycle.memory.has_stood ? -1.0 : -0.03);
}

/// Pedal to and fro at walking pace: forwards, to standstill, backwards.
void rock(AttackCycle& cycle, StepResult& answer) {
  const double pedal = is_first_half(cycle, 6.0 * cycle.memory.pace) ? 0.6 : -1.0;
  command_alone(answer, cycle.memory.side * cycle.lock, pedal);
}

void not_a_number(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, is_first_half(cycle, 2.0) ? kSmallOffset : kNan, 1.0);
}

void huge_steer(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * kHuge, 1.0);
}

void huge_everything(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * kHuge, kHuge);
}

void bad_numbers(AttackCycle& cycle, StepResult& answer) {
  const double steer = cycle.random.uniform() < 0.5 ? bad_number(cycle.random) : answer.command.steer;
  const double pedal = cycle.random.uniform() < 0.5 ? bad_number(cycle.random) : 1.0;
  command_alone(answer, steer, pedal);
}

void stop_on_road_at_lock(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * cycle.lock, 1.0);
  answer.answer = Answer::kStopOnRoad;
}

void stop_on_road_braking(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * cycle.lock, -0.02);
  answer.answer = Answer::kStopOnRoad;
}

void return_to_road_at_lock(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * cycle.lock, 1.0);
  answer.answer = Answer::kReturnToRoad;
}

void return_to_road_slowly(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * cycle.lock, cycle.now.speed < kCreepingSpeed ? 0.4 : 0.0);
  answer.answer = Answer::kReturnToRoad;
}

void none(AttackCycle&, StepResult& answer) {
  command_alone(answer, 0.0, 1.0);
  answer.answer = Answer::kNone;
}

void alternating_answers(AttackCycle& cycle, StepResult& answer) {
  const model::Command held = held_command(cycle);
  command_alone(answer, held.steer, std::fabs(held.throttle));
  answer.answer = static_cast<Answer>(cycle.random.bits() % 4U);
}

void unknown_answer(AttackCycle& cycle, StepResult& answer) {
  command_alone(answer, cycle.memory.side * cycle.lock, 1.0);
  answer.answer = static_cast<Answer>(77);
}

/// Says that its command acts at another time than it does.
void false_time(AttackCycle& cycle, StepResult& answer) {
  constexpr std::array kLate{-5.0, -0.5, 0.5, 5.0, 1e6, -1e6, kNan, kInfinity};
  const double late = kLate[static_cast<std::size_t>(cycle.since / 3.0) % kLate.size()];
  command_alone(answer, answer.command.steer + cycle.memory.side * 4.0 * kSmallOffset, 1.0);
  answer.report.act_time = cycle.now.time + cycle.now.delay + late;
}

/// Shows the nominal plan and turns the wheel.
void false_plan(AttackCycle& cycle, StepResult& answer) {
  answer.command = {.steer = cycle.memory.side * cycle.lock, .throttle = 1.0};
}

/// Shows the nominal plan and drives a little beside it.
void slightly_false_plan(AttackCycle& cycle, StepResult& answer) {
  answer.command.steer += cycle.memory.side * cycle.memory.pace * kSmallOffset;
}

/// Weaves with growing amplitude, and shows the nominal plan with its own command at the beginning.
void agreeing_plan(AttackCycle& cycle, StepResult& answer) {
  const double weave = std::sin(cycle.since * kTwoPi / (2.0 * cycle.memory.pace));
  answer.command.steer += std::min(kSwervingGrowth * cycle.since, cycle.lock) * weave;
  if (answer.plan.size > 0) answer.plan.points[0].command = answer.command;
}

/// Shows a plan that stands still on the spot, and drives straight on.
void plan_of_standing(AttackCycle& cycle, StepResult& answer) {
  answer.command = {.steer = 0.0, .throttle = 1.0};
  answer.answer = Answer::kDrive;
  answer.plan.size = std::max(answer.plan.size, 2);
  for (int i = 0; i < answer.plan.size; ++i) {
    controller::PlanPoint& point = answer.plan.points[static_cast<std::size_t>(i)];
    point = {.time = cycle.now.time + cycle.now.delay + 0.05 * i,
             .x = cycle.now.x,
             .y = cycle.now.y,
             .psi = cycle.now.psi,
             .speed = 0.0,
             .command = {.steer = 0.0, .throttle = 0.0}};
  }
}

void plan_of_bad_numbers(AttackCycle& cycle, StepResult& answer) {
  answer.command = {.steer = cycle.memory.side * cycle.lock, .throttle = 1.0};
  answer.answer = Answer::kDrive;
  answer.plan.size = std::max(answer.plan.size, 20);
  for (int i = 0; i < answer.plan.size; ++i) {
    controller::PlanPoint& point = answer.plan.points[static_cast<std::size_t>(i)];
    for (double* value : {&point.time, &point.x, &point.y, &point.psi, &point.speed, &point.command.steer,
                          &point.command.throttle})
      if (cycle.random.uniform() < 0.3) *value = bad_number(cycle.random);
  }
}

/// Another kind each 0.2 to 4 s. Not itself: it is the last of the list.
void everything(AttackCycle& cycle, StepResult& answer) {
  AdversaryMemory& memory = cycle.memory;
  if (cycle.now.time >= memory.way_until) {
    memory = {.side = cycle.random.uniform() < 0.5 ? -1.0 : 1.0,
              .pace = cycle.random.uniform(0.2, 3.0),
              .way = cycle.random.bits() % (adversary_kinds().size() - 1),
              .way_until = cycle.now.time + cycle.random.uniform(0.2, 4.0)};
  }
  adversary_kinds()[memory.way].act(cycle, answer);
}

constexpr std::array kKinds{
    AdversaryKind{"straight_on", "full throttle with the wheel straight", straight_on},
    AdversaryKind{"lock", "full throttle with the wheel at its stop", lock},
    AdversaryKind{"random", "full throttle, another steering angle each cycle", random},
    AdversaryKind{"random_hold", "a random command held for 0.2 to 3 s", random_hold},
    AdversaryKind{"bang_bang", "full throttle, the wheel from stop to stop", bang_bang},
    AdversaryKind{"full_throttle", "the nominal steering and plan with full throttle", full_throttle},
    AdversaryKind{"blind_throttle", "the nominal steering with full throttle, no plan",
                  full_throttle_without_plan},
    AdversaryKind{"hold", "the command of the first moment for ever", hold},
    AdversaryKind{"frozen_output", "the whole answer of the first moment for ever", frozen_output},
    AdversaryKind{"creep", "to the edge at 3 m/s", creep},
    AdversaryKind{"drift", "slowly to the edge at the nominal speed", drift},
    AdversaryKind{"swerve", "about the nominal steering with growing amplitude", swerve},
    AdversaryKind{"brake", "full braking with the wheel at its stop", brake},
    AdversaryKind{"reverse_gear", "brakes, and goes on after standstill with the wheel turned", reverse_gear},
    AdversaryKind{"rock", "drives and brakes in turn with the wheel turned", rock},
    AdversaryKind{"not_a_number", "each other second a steering angle that is not a number", not_a_number},
    AdversaryKind{"huge_steer", "a steering angle of 1e308", huge_steer},
    AdversaryKind{"huge_everything", "steering angle and throttle of 1e308", huge_everything},
    AdversaryKind{"bad_numbers", "NaN, infinity, 1e308 and denormal numbers in turn", bad_numbers},
    AdversaryKind{"stop_on_road", "kStopOnRoad with full lock and throttle", stop_on_road_at_lock},
    AdversaryKind{"stop_braking", "kStopOnRoad with full lock and the brake", stop_on_road_braking},
    AdversaryKind{"return_to_road", "kReturnToRoad with full lock and throttle", return_to_road_at_lock},
    AdversaryKind{"return_slowly", "kReturnToRoad with full lock at walking pace", return_to_road_slowly},
    AdversaryKind{"none", "no answer", none},
    AdversaryKind{"alternating", "all kinds of answer in turn with random commands", alternating_answers},
    AdversaryKind{"unknown_answer", "a kind of answer that does not exist", unknown_answer},
    AdversaryKind{"false_time", "commands that act at another time than it says", false_time},
    AdversaryKind{"false_plan", "the nominal plan, and a command at full lock", false_plan},
    AdversaryKind{"half_false_plan", "the nominal plan, and a command a little beside it",
                  slightly_false_plan},
    AdversaryKind{"agreeing_plan", "the nominal plan, and a weaving command that is its first",
                  agreeing_plan},
    AdversaryKind{"standing_plan", "a plan that stands, and a command at full throttle", plan_of_standing},
    AdversaryKind{"bad_plan", "a plan of NaN, infinity and 1e308 with full lock", plan_of_bad_numbers},
    AdversaryKind{"everything", "all of them in turn",
                  everything},  // the last one: it imitates those before it
};

class Adversary final : public controller::Controller {
 public:
  Adversary(const AdversaryKind& kind, std::uint64_t seed, std::unique_ptr<Controller> nominal, double lock)
      : kind_{kind}, seed_{seed}, nominal_{std::move(nominal)}, lock_{lock} {
    reset();
  }

  const StepResult& step(const model::Measurement& now, Deadline deadline) noexcept override {
    result_ = nominal_->step(now, deadline);
    if (!is_attacking(now.time)) return result_;
    AttackCycle cycle{now, now.time - began_, lock_, random_, memory_};
    kind_.act(cycle, result_);
    return result_;
  }
  void note_sent(const model::Command& command) noexcept override { nominal_->note_sent(command); }
  void use_line(std::shared_ptr<const road::RacingRoad> lap) noexcept override {
    nominal_->use_line(std::move(lap));
  }
  void reset() noexcept override {
    nominal_->reset();
    random_ = Random{seed_};
    attacks_ = false;
    switch_at_ = seed_ % 3 == 0 ? -1.0 : random_.uniform(5.0, 25.0);
  }
  [[nodiscard]] std::string_view name() const noexcept override { return kind_.name; }

 private:
  bool is_attacking(double time) noexcept {
    if (time < switch_at_) return attacks_;
    attacks_ = !attacks_;
    const bool is_lasting = seed_ % 3 != 2;
    switch_at_ = is_lasting ? kInfinity : time + random_.uniform(attacks_ ? 0.5 : 4.0, attacks_ ? 6.0 : 10.0);
    if (attacks_) {
      began_ = time;
      memory_ = {.side = random_.uniform() < 0.5 ? -1.0 : 1.0, .pace = random_.uniform(0.2, 3.0)};
    }
    return attacks_;
  }

  const AdversaryKind& kind_;
  std::uint64_t seed_;
  std::unique_ptr<Controller> nominal_;
  double lock_;
  Random random_{0};
  AdversaryMemory memory_;
  bool attacks_ = false;
  double switch_at_ = 0.0;  ///< from attacking to the nominal answer, or back [s]
  double began_ = 0.0;      ///< the attack that goes on [s]
  StepResult result_;
};

}  // namespace

std::span<const AdversaryKind> adversary_kinds() { return kKinds; }

const AdversaryKind* adversary_named(std::string_view name) {
  const auto* found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& kind) { return kind.name == name; });
  return found == kKinds.end() ? nullptr : found;
}

std::unique_ptr<controller::Controller> make_adversary(const AdversaryKind& kind, std::uint64_t seed,
                                                       std::unique_ptr<controller::Controller> nominal,
                                                       const model::VehicleParams& vehicle) {
  return std::make_unique<Adversary>(kind, seed, std::move(nominal), vehicle.steer_limit);
}

}  // namespace chicane::attack
