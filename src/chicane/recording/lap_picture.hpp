// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/recording/detail/canvas.hpp"

namespace chicane::recording {

/// One control step of a recording, as a picture needs it.
struct DrivenMoment {
  double time = 0.0;           ///< time of the run [s]
  Vec2 position{};             ///< position of the centre of mass in W [m]
  double heading = 0.0;        ///< [rad]
  double speed = 0.0;          ///< [m/s]
  double steer = 0.0;          ///< sent road-wheel angle [rad], left positive
  double throttle = 0.0;       ///< sent, [-1, 1]
  int lap = 0;                 ///< laps completed
  double lap_time = 0.0;       ///< time since the running lap began [s]
  double s = 0.0;              ///< along the track's line [m]; not-a-number where no track is known
  double edge_distance = 0.0;  ///< gap of the outermost tyre [m]; not-a-number without a track
  bool is_off_track = false;
  std::vector<Vec2> plan{};          ///< predicted positions in W [m]
  std::vector<double> plan_speed{};  ///< [m/s]
};

/// A recorded run, and its road.
struct DrivenRun {
  std::string track{}, controller{}, preset{};
  double track_length = 0.0;  ///< [m], 0: unknown
  bool is_closed = true;
  double front = 2.0, rear = 2.0, width = 1.9;  ///< body ahead, behind and across [m]
  double steer_limit = 0.4;                     ///< [rad]
  std::vector<Vec2> left{}, right{};            ///< edges of the road in W [m]
  std::vector<DrivenMoment> moments{};
  int last_lap = 0;  ///< number of the last one that was driven to its end; 0: none was

  /// Moments of lap number `lap`, counted from 1; 0: all. Empty when there are none.
  [[nodiscard]] std::vector<DrivenMoment> of_lap(int lap) const;
};

/// Reads the last run of a recording of `drive`, `simulate` or `serve`. kParse for a file that is no
/// recording of ours or has no control step; otherwise fails as telemetry::read_mcap() does.
[[nodiscard]] Result<DrivenRun> read_run(const std::string& recording);

struct PictureOptions {
  int width = 1280;          ///< [px], even; [160, 3840]
  int height = 720;          ///< [px], even; [90, 2160]
  bool shows_whole = false;  ///< the whole road all the time, and not the car from above
  double view = 110.0;       ///< width of the view that follows the car [m]
};

/// Draws moments of a run from above: road, car, plan in the colours of its speed, where it has been, and
/// another run's car as a ghost; in words speed, lap time, the time lost to the ghost at the same place, and
/// how far the lap is. A small map shows the whole road.
class LapPicture {
 public:
  /// `shown`: moments to draw, in order of time; `ghost`: moments of the other run, empty without one. Both
  /// are drawn from the same moment: the ghost is shown at the same time since its own start.
  LapPicture(const DrivenRun& run, std::vector<DrivenMoment> shown, std::vector<DrivenMoment> ghost,
             const PictureOptions& options);

  /// Duration of the pictures [s].
  [[nodiscard]] double duration() const;
  /// The picture `time` [s] after the beginning; held at both ends.
  [[nodiscard]] const Canvas& at(double time);
  /// Delay of the car behind the ghost at the same place, `time` after the start [s]; none where one of them
  /// has not been.
  [[nodiscard]] std::optional<double> lost_to_ghost(double time) const;

 private:
  struct Camera {
    Vec2 middle{};
    double scale = 1.0;  ///< [px/m]
    Vec2 corner{};       ///< corner of the picture, drawn at the middle [px]
    [[nodiscard]] Vec2 operator()(const Vec2& point) const;
  };
  [[nodiscard]] Camera whole(double x, double y, double width, double height) const;
  void draw_road(const Camera& camera, double edge);
  void draw_car(const Camera& camera, const DrivenMoment& moment, const Colour& colour);
  void draw_plan(const Camera& camera, const DrivenMoment& moment);
  void draw_trace(const Camera& camera, double time);
  void draw_map(const DrivenMoment& moment, const std::optional<DrivenMoment>& other);
  /// Share of the lap that is driven, from where it began; none where no track is known.
  [[nodiscard]] std::optional<double> progress(const DrivenMoment& moment) const;
  void draw_words(const DrivenMoment& moment, double time);

  const DrivenRun& run_;
  std::vector<DrivenMoment> shown_, ghost_;
  PictureOptions options_;
  Canvas canvas_;
  double top_speed_ = 1.0;
};

}  // namespace chicane::recording
