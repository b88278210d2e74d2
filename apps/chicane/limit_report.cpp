// SPDX-License-Identifier: MIT
#include "limit_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "chicane/base/angle.hpp"

namespace chicane::apps {

std::string to_table(const LimitRun& run, const lap_time::Limit& limit) {
  const lap_time::LimitReport& report = limit.report;
  std::string text =
      fmt::format("{} on {}: {:.3f} s ({:.3f} {:.3f} {:.3f} by thirds)\n", run.car, run.track,
                  limit.times.lap, limit.times.sectors[0], limit.times.sectors[1], limit.times.sectors[2]);
  text +=
      fmt::format("speed {:.1f} mph on average, {:.1f} at least, {:.1f} at most; the line is {:.1f} m long\n",
                  mps_to_mph(limit.mean_speed), mps_to_mph(limit.least_speed), mps_to_mph(limit.top_speed),
                  limit.line_length);
  text += fmt::format("found in {:.1f} s: {} stages of {:.2f} m, {} rounds, {} turns of the solver\n",
                      run.wall_time, report.stages, report.spacing, report.rounds, report.iterations);
  text += fmt::format(
      "the last round: {:.1e} of the lap time, {:.4f} m of the line; violation {:.4f}, seam {:.4f} m, {:.4f} "
      "m/s\n",
      report.last_change, report.last_offset, report.violation, report.seam_offset, report.seam_speed);
  return text;
}

std::string to_json(const LimitRun& run, const lap_time::Limit& limit) {
  const lap_time::LimitReport& report = limit.report;
  const nlohmann::ordered_json json{{"track", run.track},
                                    {"car", run.car},
                                    {"lap_time_s", limit.times.lap},
                                    {"sector_times_s", limit.times.sectors},
                                    {"mean_speed_mps", limit.mean_speed},
                                    {"least_speed_mps", limit.least_speed},
                                    {"top_speed_mps", limit.top_speed},
                                    {"line_length_m", limit.line_length},
                                    {"stages", report.stages},
                                    {"spacing_m", report.spacing},
                                    {"rounds", report.rounds},
                                    {"iterations", report.iterations},
                                    {"stationarity", report.stationarity},
                                    {"last_offset_m", report.last_offset},
                                    {"last_change", report.last_change},
                                    {"violation", report.violation},
                                    {"seam_offset_m", report.seam_offset},
                                    {"seam_speed_mps", report.seam_speed},
                                    {"wall_time_s", run.wall_time}};
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string to_csv(const LimitRun& run, const path::Track& track, const lap_time::Limit& limit) {
  std::string text = fmt::format(
      "# Fastest lap of {} on {}: {:.4f} s (chicane limit, docs/limit.md)\n"
      "# start_s_m=0, kerb_width_m={:g}, smoothing_sigma_m=0.02, closed=true\n"
      "# "
      "x_m,y_m,w_tr_right_m,w_tr_left_m,s_m,n_m,time_s,heading_rad,curvature_radpm,v_mps,ax_mps2,ay_mps2\n",
      run.car, run.track, limit.times.lap, track.kerb_width());
  for (std::size_t i = 0; i + 1 < limit.line.size(); ++i) {  // the last repeats the first
    const path::LinePoint& p = limit.line[i];
    text +=
        fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},{:.3f},{:.4f},{:.4f},{:.5f},{:.6f},{:.4f},{:.4f},{:.4f}\n",
                    p.position.x(), p.position.y(), p.right, p.left, p.s, p.d, p.time, p.heading, p.curvature,
                    p.speed, p.longitudinal_acceleration, p.lateral_acceleration);
  }
  return text;
}

}  // namespace chicane::apps
