// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "chicane/protocol/library.hpp"
#include "conversion.hpp"
#include "crew.hpp"
#include "environment.hpp"
#include "faces.hpp"

namespace chicane::python {
namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

Observation observation_named(const std::string& name) {
  if (name == "track") return Observation::kTrack;
  if (name == "waypoints") return Observation::kWaypoints;
  if (name == "pose") return Observation::kPose;
  if (name == "scan") return Observation::kScan;
  throw py::value_error("observation: got \"" + name + "\", expected one of track, waypoints, pose, scan");
}

EnvironmentOptions options_of(const py::dict& given) {
  EnvironmentOptions options;
  options.observation = observation_named(given["observation"].cast<std::string>());
  options.off_road_cost = given["off_road_cost"].cast<double>();
  options.ends_off_road = given["ends_off_road"].cast<bool>();
  options.episode_limit = given["episode_s"].cast<double>();
  options.starts_anywhere = given["starts_anywhere"].cast<bool>();
  for (const auto& [key, range] : given["randomise"].cast<py::dict>()) {
    const auto [low, high] = range.cast<std::pair<double, double>>();
    options.draws.push_back({key.cast<std::string>(), low, high});
  }
  options.faults = given["random_faults"].cast<std::vector<std::string>>();
  return options;
}

std::unique_ptr<Environment> make_environment(const protocol::Request& request, const py::dict& given,
                                              const std::shared_ptr<run::Roads>& roads) {
  const EnvironmentOptions options = options_of(given);
  return value_of(unlocked([&]() -> Result<std::unique_ptr<Environment>> {
    const Result<scenario::Scenario> scenario = protocol::compose(request);
    if (!scenario) return fail(scenario.error());
    return Environment::create(*scenario, options, roads);
  }));
}

void check_shape(const Numbers& actions, std::size_t count) {
  if (actions.ndim() == 2 && static_cast<std::size_t>(actions.shape(0)) == count && actions.shape(1) == 2)
    return;
  throw py::value_error("actions: got an array of another shape, expected (" + std::to_string(count) +
                        ", 2)");
}

Numbers observation_of(const Environment& environment) {
  Numbers observation(static_cast<py::ssize_t>(environment.size()));
  environment.observe({observation.mutable_data(), environment.size()});
  return observation;
}

/// A key that is made once; keys of each step cost as much as the values.
py::handle key(const char* name) { return PyUnicode_InternFromString(name); }

/// The truth, which an agent does not get.
py::dict info_of(const Environment& environment) {
  static const std::array keys{key("time_s"),    key("s_m"), key("lateral_error_m"), key("edge_distance_m"),
                               key("speed_mps"), key("lap"), key("is_off_track")};
  const run::ClosedLoop& loop = environment.loop();
  const sim::WorldState& world = loop.world();
  const std::array<py::object, keys.size()> values{
      py::float_(loop.time()),         py::float_(world.s),       py::float_(world.lateral_error),
      py::float_(world.edge_distance), py::float_(loop.car().vx), py::int_(world.lap),
      py::bool_(world.is_off_track)};
  py::dict info;
  for (std::size_t n = 0; n < keys.size(); ++n) PyDict_SetItem(info.ptr(), keys[n].ptr(), values[n].ptr());
  return info;
}

/// Places of both edges of the road, (n, 2), nearer than a 400th of its length.
Numbers edges_of(const Environment& environment) {
  constexpr int kPlaces = 2000;  // on each side
  const road::Track& track = environment.loop().track();
  Numbers edges({py::ssize_t{2 * kPlaces}, py::ssize_t{2}});
  double* to = edges.mutable_data();
  for (int i = 0; i < kPlaces; ++i) {
    const double s = track.length() * i / kPlaces;
    const auto at = track.centre().at(s);
    const Vec2 left{-std::sin(at.heading), std::cos(at.heading)};
    for (const double d : {track.left_width(s), -track.right_width(s)}) {
      const Vec2 place = at.position + d * left;
      *to++ = place.x();
      *to++ = place.y();
    }
  }
  return edges;
}

py::tuple step(Environment& environment, const Numbers& action) {
  if (action.ndim() != 1 || action.shape(0) != 2)
    throw py::value_error(
        "action: got an array of another shape, expected (2,): steer [rad], throttle [-1, 1]");
  const model::Command command{action.at(0), action.at(1)};
  check_command("action", command);
  const StepOutcome outcome = unlocked([&] { return environment.step(command); });
  return py::make_tuple(observation_of(environment), outcome.reward, outcome.terminated, outcome.truncated,
                        info_of(environment));
}

/// Actions (n, 2), each with its observation, without Python between them: what steps cost in C++
/// (speed_table.py). Returns how many there were before the episode ended.
int repeat(Environment& environment, const Numbers& actions) {
  check_shape(actions, static_cast<std::size_t>(actions.ndim() == 2 ? actions.shape(0) : 1));
  const double* const commands = actions.data();
  const auto count = static_cast<int>(actions.shape(0));
  return unlocked([&] {
    std::vector<double> seen(environment.size());
    for (int n = 0; n < count; ++n) {
      const StepOutcome outcome = environment.step({commands[2 * n], commands[2 * n + 1]});
      environment.observe(seen);
      if (outcome.terminated || outcome.truncated) return n + 1;
    }
    return count;
  });
}

/// Many environments that are stepped together on threads; the bits do not depend on how many.
class Batch {
 public:
  Batch(const protocol::Request& request, const py::dict& given, int count, int threads) : crew_{threads} {
    const auto roads = std::make_shared<run::Roads>();
    for (int i = 0; i < count; ++i) environments_.push_back(make_environment(request, given, roads));
  }

  [[nodiscard]] std::size_t size() const noexcept { return environments_.size(); }
  [[nodiscard]] int threads() const noexcept { return crew_.threads(); }
  [[nodiscard]] Environment& at(std::size_t i) const { return *environments_.at(i); }

  Numbers reset(std::uint64_t seed) {
    next_seed_ = seed;
    for (const auto& environment : environments_) check(environment->reset(next_seed_++));
    Numbers observations = make_observations();
    write(observations);
    return observations;
  }

  /// Observation, reward, terminated, truncated, the last observation of episodes that ended (those begin
  /// again at once), and the truth at the last observations where it is wanted.
  py::tuple step(const Numbers& actions, bool wants_truth) {
    check_shape(actions, size());
    for (py::ssize_t i = 0; i < actions.shape(0); ++i)
      check_command("actions", {actions.at(i, 0), actions.at(i, 1)});
    std::vector<StepOutcome> outcomes(size());
    Numbers last = make_observations();
    const double* const commands = actions.data();
    double* const seen = last.mutable_data();
    const std::size_t width = environments_[0]->size();
    const std::function<void(std::size_t)> step = [&](std::size_t i) {
      outcomes[i] = environments_[i]->step({commands[2 * i], commands[2 * i + 1]});
      environments_[i]->observe({seen + i * width, width});
    };
    unlocked([&] { crew_.run(size(), step); });
    py::list truths;
    if (wants_truth)
      for (const auto& environment : environments_) truths.append(info_of(*environment));
    const bool has_ended = std::any_of(outcomes.begin(), outcomes.end(), [](const StepOutcome& outcome) {
      return outcome.terminated || outcome.truncated;
    });
    if (!has_ended) return result_of(last, outcomes, last, truths);
    begin_anew(outcomes);
    Numbers observations = make_observations();
    write(observations);
    return result_of(observations, outcomes, last, truths);
  }

 private:
  void begin_anew(const std::vector<StepOutcome>& outcomes) {
    for (std::size_t i = 0; i < size(); ++i) {
      if (outcomes[i].terminated || outcomes[i].truncated) check(environments_[i]->reset(next_seed_++));
    }
  }
  [[nodiscard]] Numbers make_observations() const {
    return Numbers({static_cast<py::ssize_t>(size()), static_cast<py::ssize_t>(environments_[0]->size())});
  }
  void write(Numbers& to) const {
    const std::size_t width = environments_[0]->size();
    for (std::size_t i = 0; i < size(); ++i)
      environments_[i]->observe({to.mutable_data() + i * width, width});
  }
  static py::tuple result_of(const Numbers& observations, const std::vector<StepOutcome>& outcomes,
                             const Numbers& last, const py::list& truths) {
    const auto count = static_cast<py::ssize_t>(outcomes.size());
    py::array_t<double> rewards(count);
    py::array_t<bool> terminated(count), truncated(count);
    for (py::ssize_t i = 0; i < count; ++i) {
      const StepOutcome& outcome = outcomes[static_cast<std::size_t>(i)];
      rewards.mutable_at(i) = outcome.reward;
      terminated.mutable_at(i) = outcome.terminated;
      truncated.mutable_at(i) = outcome.truncated;
    }
    return py::make_tuple(observations, rewards, terminated, truncated, last, truths);
  }

  Crew crew_;
  std::uint64_t next_seed_ = 0;
  std::vector<std::unique_ptr<Environment>> environments_;
};

}  // namespace

void add_environment(py::module_& module) {
  py::class_<Environment>(module, "Environment")
      .def(py::init([](const protocol::Request& request, const py::dict& options) {
             return make_environment(request, options, std::make_shared<run::Roads>());
           }),
           py::arg("request"), py::arg("options"))
      .def("reset",
           [](Environment& self, std::uint64_t seed) { check(unlocked([&] { return self.reset(seed); })); })
      .def("step", step, py::arg("action"))
      .def("repeat", repeat, py::arg("actions"))
      .def("observe", observation_of)
      .def("info", info_of)
      .def("edges", edges_of)
      .def("pose",
           [](const Environment& self) {
             const model::State& car = self.loop().car();
             return py::make_tuple(car.x, car.y, car.psi);
           })
      .def("set", [](Environment& self, const std::string& key,
                     const std::string& text) { check(self.set(key, text)); })
      .def_property_readonly("size", &Environment::size)
      .def_property_readonly("drawn", &Environment::drawn)
      .def_property_readonly("steps", &Environment::steps)
      .def_property_readonly(
          "steer_limit", [](const Environment& self) { return self.loop().scenario().vehicle.steer_limit; })
      .def_property_readonly("state_hash",
                             [](const Environment& self) { return self.loop().summary().state_hash; });
  py::class_<Batch>(module, "Batch")
      .def(py::init<const protocol::Request&, const py::dict&, int, int>(), py::arg("request"),
           py::arg("options"), py::arg("count"), py::arg("threads"))
      .def("reset", &Batch::reset, py::arg("seed"))
      .def("step", &Batch::step, py::arg("actions"), py::arg("wants_truth"))
      .def("at", &Batch::at, py::return_value_policy::reference_internal)
      .def_property_readonly("threads", &Batch::threads)
      .def("__len__", &Batch::size);
}

}  // namespace chicane::python
