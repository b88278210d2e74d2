// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "chicane/base/math.hpp"
#include "chicane/sim/plant.hpp"

namespace chicane::sim {

/// A cart that rolls where its front wheels point, with no slip and no drag.
class Cart final : public Plant {
 public:
  static constexpr std::string_view kName = "cart";
  static constexpr std::string_view kMeaning = "rolls where its wheels point";

  [[nodiscard]] double step_length() const noexcept override { return kStep; }
  void reset(const model::Pose& pose, double speed) noexcept override {
    state_ = {.x = pose.x, .y = pose.y, .psi = pose.psi, .vx = speed};
    output_.speed = speed;
  }
  void set_motion(const Vec2& velocity, double /*yaw_rate*/) noexcept override {
    state_.vx = output_.speed = velocity.x();
  }
  void deviate(const PlantDeviation& /*deviation*/) noexcept override {}
  void advance(const model::Command& command) noexcept override {
    state_.steer = command.steer;
    state_.vx += kStep * 4.0 * command.throttle;
    state_.x += kStep * state_.vx * cos(state_.psi);
    state_.y += kStep * state_.vx * sin(state_.psi);
    state_.psi += kStep * state_.vx / 2.5 * tan(command.steer);
    output_.speed = state_.vx;
  }
  [[nodiscard]] const model::State& state() const noexcept override { return state_; }
  [[nodiscard]] const PlantOutput& output() const noexcept override { return output_; }
  [[nodiscard]] std::array<Vec2, 4> contact_points() const noexcept override {
    return {Vec2{1.25, 0.7}, Vec2{1.25, -0.7}, Vec2{-1.25, 0.7}, Vec2{-1.25, -0.7}};
  }

 private:
  static constexpr double kStep = 0.01;  // [s]
  model::State state_;
  PlantOutput output_;
};

}  // namespace chicane::sim
