// SPDX-License-Identifier: MIT
// `chicane identify`: estimates the parameters of a car from logs, beginning with a given car or one of the
// shelf, and writes the car file and the page.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>

#include "chicane/base/file.hpp"
#include "chicane/base/text.hpp"
#include "chicane/identify/identification.hpp"
#include "chicane/live/pages.hpp"
#include "chicane/model/vehicle.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/origin.hpp"
#include "chicane/protocol/schema.hpp"
#include "chicane/recording/html_report.hpp"
#include "chicane/sim/double_track.hpp"
#include "commands.hpp"
#include "experiment.hpp"
#include "lab/identify_page.hpp"
#include "lab/many_runs.hpp"
#include "option_row.hpp"
#include "program.hpp"
#include "progress.hpp"

namespace chicane::apps {
namespace {

using identify::Estimate;
using identify::Identification;

constexpr std::size_t kMostColumns = 1000;  // limit of the index of a column: bounds memory; chosen

/// Options of the reader of logs by the command line.
Result<identify::LogOptions> log_options(const Options::Identify& options) {
  identify::LogOptions log{.odom_topic = options.odom_topic, .drive_topic = options.drive_topic};
  for (const std::string& column : options.columns) {
    const std::size_t equals = column.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == column.size())
      return fail(refusal("--columns", column,
                          "MEANING=NAME such as steer=delta_rad, or POSITION=MEANING such as 0=time"));
    const std::string left = column.substr(0, equals);
    std::size_t position = 0;
    const auto end = std::from_chars(left.data(), left.data() + left.size(), position);
    if (end.ec == std::errc{} && end.ptr == left.data() + left.size() && position < kMostColumns)
      log.positions[position] = column.substr(equals + 1);
    else
      log.columns[left] = column.substr(equals + 1);
  }
  if (!log.positions.empty() && !log.columns.empty())
    return fail(refusal("--columns", fmt::format("{}", fmt::join(options.columns, ",")),
                        "names or positions for all columns"));
  return log;
}

/// Progress of the search with the time left. The search ends at an interrupt, and at the end of its time
/// budget.
class Share {
 public:
  Share(const std::atomic<bool>& wants_stop, double budget_s) : wants_stop_{wants_stop}, budget_{budget_s} {}
  /// Shows the share that is done. Returns whether the search goes on.
  bool operator()(double done) {
    const auto percent = static_cast<std::uint64_t>(100.0 * done);
    counter_.show(percent, 100, percent);
    return goes_on();
  }
  [[nodiscard]] bool goes_on() const { return !wants_stop_ && !is_late(); }
  /// Whether the time budget is over.
  [[nodiscard]] bool is_late() const { return std::chrono::steady_clock::now() - begin_ > budget_; }
  /// Ends the line of progress.
  void clear() { counter_.end(); }

 private:
  const std::atomic<bool>& wants_stop_;
  std::chrono::duration<double> budget_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  RunCounter counter_{"percent"};
};

/// Interval of an estimate as text.
std::string interval(const Estimate& each) {
  return fmt::format("{} to {}", number_text(each.low, 3), number_text(each.high, 3));
}

/// Reason not to use the car: its prediction errors; empty if the predictions are good.
std::string doubt(const Identification& found) {
  if (found.predicts()) return {};
  const identify::PredictionError& error = found.held_out.front();
  const auto [most, most_yaw] = found.worst_prediction();
  constexpr double kDegrees = 180.0 / kPi;
  return fmt::format(
      "held-out prediction: got {:.2f} m and {:.1f} deg off after {:.2g} s, expected at most {:.2f} m and "
      "{:.1f} deg (six times what the fit leaves unexplained, or a car that keeps its speed and yaw rate)",
      error.position, kDegrees * error.yaw, error.ahead, most, kDegrees * most_yaw);
}

/// Sentences about what the logs do not show, a line each.
std::string advice(const Identification& found) {
  constexpr double kOffCentre = 0.1;  // [deg] offset of the steering worth a sentence; chosen
  std::string text;
  if (!found.has_pedal)
    text += "The log has no pedal: drive, brakes and drag are those of the car it began with.\n";
  if (!found.knows_tires())
    text += fmt::format(
        "The tyres reached {:.0f} % (front) and {:.0f} % (rear) of their peak: grip is not known, and race "
        "refuses this car. Drive bends nearer to the limit, at least {:.0f} % at one axle, or state the "
        "friction "
        "that you know it to have{}.\n",
        100.0 * found.use_front, 100.0 * found.use_rear, 100.0 * identify::kRaceUse,
        found.shown_friction() > 0.1
            ? fmt::format(": the log shows --set friction_low={}", number_text(found.shown_friction(), 2))
            : " (friction_low)");
  if (found.correlation > identify::kWrongModel)
    text += fmt::format(
        "What is left unexplained is not noise ({:.0f} samples tell as much as one that is): the model lacks "
        "something of this car. The intervals hold for the model, and may miss the car's own numbers.\n",
        found.correlation);
  for (const Estimate& each : found.estimates) {
    if (each.key == "steer_offset_deg" && each.is_excited &&
        (each.low > kOffCentre || each.high < -kOffCentre))
      text += fmt::format("The wheels point {} deg {} when 0 is asked: correct it where commands are sent.\n",
                          number_text(std::fabs(each.value), 2), each.value > 0.0 ? "left" : "right");
  }
  return text;
}

/// Result as text.
std::string table_of(const Identification& found, const std::string& logs) {
  std::string text = fmt::format("{:.0f} s of driving from {}\n\n{:<26} {:>10} {:>22}  {:>8}\n", found.driven,
                                 logs, "", "found", "95 % interval", "assumed");
  for (const Estimate& each : found.estimates)
    text += fmt::format("{:<26} {:>9}{} {:>22}  {:>8} {}\n", each.key, number_text(each.value, 4),
                        each.is_excited ? ' ' : '*', interval(each), number_text(each.assumed, 4), each.unit);
  text += fmt::format(
      "* not excited: the log hardly narrows what was assumed\n"
      "\ntyres used           {:.0f} % of the peak at the front, {:.0f} % at the rear\n"
      "left unexplained     {:.3f} m, {:.2f} deg, {:.3f} m/s\n",
      100.0 * found.use_front, 100.0 * found.use_rear, found.residual[0], found.residual[1] * 180.0 / kPi,
      found.residual[2]);
  for (const identify::PredictionError& error : found.held_out)
    text += fmt::format("predicted {:.2g} s ahead  {:.2f} m, {:.1f} deg, {:.2f} m/s off (held-out part)\n",
                        error.ahead, error.position, error.yaw * 180.0 / kPi, error.speed);
  for (std::string words = advice(found); !words.empty(); words.erase(0, words.find('\n') + 1))
    text += "\n" + wrapped(words.substr(0, words.find('\n')), 0, 0);
  return text;
}

/// Result as JSON.
std::string json_of(const Identification& found) {
  nlohmann::ordered_json json;
  json["driven_s"] = found.driven;
  json["delay_ms"] = 1e3 * found.delay;
  for (const Estimate& each : found.estimates)
    json["estimates"].push_back({{"key", each.key},
                                 {"unit", each.unit},
                                 {"value", each.value},
                                 {"low", each.low},
                                 {"high", each.high},
                                 {"assumed", each.assumed},
                                 {"is_excited", each.is_excited}});
  json["residual_m"] = found.residual[0];
  json["correlation"] = found.correlation;
  json["tire_use"] = {found.use_front, found.use_rear};
  json["knows_tires"] = found.knows_tires();
  json["predicts"] = found.predicts();
  json["friction_low"] = found.least_friction();
  json["friction_shown"] = found.shown_friction();
  json["held_out"] = nlohmann::ordered_json::array();
  for (const identify::PredictionError& error : found.held_out)
    json["held_out"].push_back({{"ahead_s", error.ahead},
                                {"position_m", error.position},
                                {"yaw_rad", error.yaw},
                                {"speed_mps", error.speed}});
  return json.dump(2) + "\n";
}

/// Whether the plant of a scenario has four wheels.
bool has_wheels(const scenario::Scenario& scenario) {
  return scenario.plant == sim::DoubleTrack::kName || scenario.plant == sim::DoubleTrack::kRoadCar;
}

/// Gives a plant of four wheels the found parameters. Other plants, and cars with a steer helper, stay as
/// they are.
void take_plant(scenario::Scenario& scenario, const identify::Wheels& wheels) {
  if (!has_wheels(scenario) || scenario.vehicle.steer_helper > 0.0) return;
  scenario.plant = sim::DoubleTrack::kName;
  scenario.plant_params = sim::plant_of(scenario.vehicle, scenario.plant_params);
  scenario.plant_params.relaxation_across = wheels.relaxation;
  scenario.plant_params.load_lag = wheels.load_lag;
}

/// Car file with the found model, and a plant with the same parameters. `scenario`: start of the search.
std::string to_car(const Identification& found, scenario::Scenario scenario, const std::string& logs) {
  std::string text =
      fmt::format("# {}, identified from {:.0f} s of {}\n", scenario.vehicle.name, found.driven, logs);
  if (!found.knows_tires())
    text += fmt::format(
        "# Grip is not known: the tyres were used too little. Race by it only with --set "
        "friction_low=NUMBER; the log shows {}.\n",
        number_text(found.shown_friction(), 2));
  if (!found.predicts()) text += "# Written by --force: " + doubt(found) + "\n";
  text +=
      "# [log] 95 % interval in brackets; [assumed] as the car it began with, because the log does not "
      "excite it.\n";
  const scenario::Scenario fresh;
  scenario.vehicle = found.vehicle;
  scenario.friction_low = found.least_friction();
  take_plant(scenario, found.wheels);
  std::string group;
  for (const protocol::Parameter& row : protocol::list()) {
    const bool is_vehicle = row.group == "vehicle";
    if (row.key == "latency_ms") {
      text += fmt::format("latency_ms: {}\n", number_text(std::round(1e4 * found.delay) / 10.0));
      continue;
    }
    if (row.key == "friction_low") {
      text += fmt::format("friction_low: {}  # least friction that the log shows; 0: none, no race\n",
                          number_text(scenario.friction_low, 4));
      continue;
    }
    if (row.key != "plant" && row.key != "control_period_ms" && !is_vehicle && row.group != "plant_params")
      continue;
    if (!is_vehicle && row.key != "plant" &&
        protocol::get_text(scenario, row) == protocol::get_text(fresh, row))
      continue;
    if (row.group != group) text += fmt::format("{}:\n", row.group);
    group = row.group;
    const std::string_view key = row.key.substr(row.group.empty() ? 0 : row.group.size() + 1);
    std::string value = protocol::get_text(scenario, row);
    std::string remark;
    for (const Estimate& each : found.estimates) {
      if (!is_vehicle || each.key != key) continue;
      value = number_text(each.value, 5);
      remark = fmt::format("  # {}", each.is_excited ? protocol::band_remark(each.low, each.high)
                                                     : std::string{protocol::kAssumedRemark});
    }
    text += fmt::format("{}{}: {}{}\n", row.group.empty() ? "" : "  ", key, value, remark);
  }
  return text;
}

/// Car of the shelf.
struct ShelfCar {
  std::string name;
  model::VehicleParams vehicle;
  double ratio = 0.0;  ///< size of the logarithm of its wheelbase over the wheelbase of the logs
};

/// Raises the steering rate of a starting car to that of an ordinary car, because the search does not find a
/// higher rate from a low one.
void forget_slow_steering(model::VehicleParams& car) {
  constexpr double kUsualRate = 90.0 * kPi / 180.0;  // [rad/s] in full size; chosen
  car.steer_rate_limit = std::max(car.steer_rate_limit, kUsualRate * model::Similarity(car).time());
}

/// Cars of the shelf, the most similar wheelbase first.
std::vector<ShelfCar> shelf_by_wheelbase(double wheelbase) {
  std::vector<ShelfCar> cars;
  for (const protocol::Entry& entry : protocol::entries(protocol::Shelf::kCar)) {
    auto car = protocol::compose({.scenario_file = {}, .settings = {{"car", entry.name}}});
    // A steer helper turns the car, too, so that its wheelbase says little; and only simulators have one.
    if (!car || car->vehicle.steer_helper > 0.0) continue;
    forget_slow_steering(car->vehicle);
    cars.push_back({entry.name, car->vehicle, std::fabs(std::log(car->vehicle.wheelbase() / wheelbase))});
  }
  std::stable_sort(cars.begin(), cars.end(), [](const auto& a, const auto& b) { return a.ratio < b.ratio; });
  return cars;
}

/// Car of the shelf with which the search begins without --car: of the cars that turn as in the logs, the one
/// with the best rough fit.
Result<std::string> car_for(const std::vector<identify::DriveLog>& logs, const std::function<bool()>& go_on) {
  constexpr double kNear = 0.35;         // largest ShelfCar::ratio of a tried car; chosen
  constexpr std::size_t kMostTried = 4;  // limit of tried cars; chosen
  const double wheelbase = identify::turning_wheelbase(logs);
  const std::vector<ShelfCar> cars =
      std::isfinite(wheelbase) ? shelf_by_wheelbase(wheelbase) : std::vector<ShelfCar>{};
  if (cars.empty())
    return fail(ErrorCode::kInvalidArgument,
                "--car: got none, and too few bends in the log to tell the car's size by, expected a car");
  const ShelfCar* best = &cars.front();
  double least = std::numeric_limits<double>::infinity();
  std::size_t tried = 0;
  while (tried < std::min(cars.size(), kMostTried) && (tried == 0 || cars[tried].ratio < kNear)) ++tried;
  for (std::size_t i = 0; i < tried && tried > 1; ++i) {
    const auto rough =
        identify::identify(logs, cars[i].vehicle,
                           {.hold_out = 0.0, .is_rough = true, .progress = [&](double) { return go_on(); }});
    if (!rough || !(rough->loss < least)) continue;
    least = rough->loss;
    best = &cars[i];
  }
  fmt::print(
      stderr,
      "identify: without --car the search begins with {} ({:.3g} m between the axles): the log turns as "
      "{:.3g} m would{}\n",
      best->name, best->vehicle.wheelbase(), wheelbase,
      tried > 1 ? fmt::format(", and of the {} cars nearest to that this one explains it best", tried) : "");
  return best->name;
}

/// Whether the car of the logs is not known: they are logs of other programs, and there is no --car.
bool is_of_unknown_car(const std::vector<identify::DriveLog>& logs, const Options& options) {
  return !has_setting(options, "car") &&
         std::none_of(logs.begin(), logs.end(),
                      [](const identify::DriveLog& log) { return log.is_centre_of_mass; });
}

/// Expected effects of the wheels: those of the plant of the start, if it has four wheels.
identify::Wheels wheels_of(const scenario::Scenario& start) {
  if (!has_wheels(start)) return {};
  const sim::DoubleTrackParams plant =
      start.plant == sim::DoubleTrack::kRoadCar ? sim::DoubleTrackParams{} : start.plant_params;
  const double turning = 4.0 * plant.wheel_inertia / (plant.wheel_radius * plant.wheel_radius);
  return {.relaxation = plant.relaxation_across,
          .load_lag = plant.load_lag,
          .rotating = 1.0 + turning / plant.mass,
          .brakes = {plant.abs_slip_start, plant.abs_slip_end},
          .drive = {plant.traction_slip_start, plant.traction_slip_end}};
}

/// Runs `chicane identify`.
Result<void> identify_and_report(const Options& options) {
  static std::atomic<bool> wants_stop{false};  // static: must outlive the last signal
  catch_interrupts(wants_stop);
  Result<scenario::Scenario> start = protocol::compose({.scenario_file = {}, .settings = options.settings});
  if (!start) return fail(start.error());
  const auto how = log_options(options.identify);
  if (!how) return fail(how.error());
  if (Result<void> named = check_page_name("--report", options.report_file); !named) return named;
  for (const std::string& file : {options.output_file, options.report_file})
    if (Result<void> writable = check_writable(file); !writable) return writable;
  std::vector<identify::DriveLog> logs;
  std::string names;
  for (const std::string& file : options.log_files) {
    auto parts = identify::read_log(file, *how);
    if (!parts) return fail(parts.error());
    std::move(parts->begin(), parts->end(), std::back_inserter(logs));
    names += (names.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  }
  Share share(wants_stop, options.identify.budget_s);
  if (is_of_unknown_car(logs, options)) {
    const Result<std::string> car = car_for(logs, [&] { return share.goes_on(); });
    if (!car) return fail(car.error());
    auto settings = options.settings;
    settings.insert(settings.begin(), {"car", *car});
    start = protocol::compose({.scenario_file = {}, .settings = settings});
    if (!start) return fail(start.error());
    forget_slow_steering(start->vehicle);
  }
  const auto found = identify::identify(logs, start->vehicle,
                                        {.hold_out = options.identify.hold_out,
                                         .wheels = wheels_of(*start),
                                         .progress = [&](double done) { return share(done); }});
  share.clear();
  if (!found) return fail(found.error());
  if (wants_stop) fmt::print(stderr, "identify: interrupted, these are the values so far\n");
  if (!wants_stop && share.is_late())
    fmt::print(stderr, "identify: {:g} s (--budget-s) are over, these are the values so far\n",
               options.identify.budget_s);
  const bool is_kept = !options.output_file.empty() && (found->predicts() || options.identify.is_forced);
  if (is_kept) {
    if (Result<void> kept = write_file(options.output_file, to_car(*found, *start, names)); !kept)
      return kept;
  }
  const bool may_race = found->knows_tires() && found->predicts();
  const std::string command = !is_kept ? ""
                                       : fmt::format("chicane drive --car {}{}", options.output_file,
                                                     may_race ? " --preset race" : "");
  if (!options.report_file.empty()) {
    const auto kept = recording::write_document(
        options.report_file,
        identify_document(*found, {.logs = names, .advice = advice(*found), .command = command}),
        live::document_bundle());
    if (!kept) return fail(kept.error());
  }
  fmt::print("{}", options.is_json ? json_of(*found) : table_of(*found, names));
  if (!command.empty() && !options.is_json) fmt::print("\n{}: {}\n", options.output_file, command);
  if (!options.output_file.empty() && !is_kept)
    return fail(ErrorCode::kInvalidArgument, doubt(*found) + ": no car is written (--force writes it)");
  return {};
}

}  // namespace

ExitCode identify_car(const Options& options) {
  const Result<void> done = identify_and_report(options);
  return done ? kSuccess : report(done.error());
}

}  // namespace chicane::apps
