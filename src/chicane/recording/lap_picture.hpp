// SPDX-License-Identifier: MIT
// Pictures of a recorded drive from above, one for each moment: the frames of a film.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"
#include "chicane/base/vec2.hpp"
#include "chicane/recording/detail/canvas.hpp"

namespace chicane::recording {

/// Control step of a recording, with everything that a picture shows.
struct DrivenMoment {
  double time = 0.0;                 ///< time of the run [s]
  Vec2 position{};                   ///< position of the centre of mass in W [m]
  double heading = 0.0;              ///< [rad]
  double speed = 0.0;                ///< [m/s]
  double steer = 0.0;                ///< sent road-wheel angle [rad], left positive
  double throttle = 0.0;             ///< sent throttle, [-1, 1]
  int lap = 0;                       ///< laps completed
  double lap_time = 0.0;             ///< time since the running lap began [s]
  double s = 0.0;                    ///< position along the track's line [m]; NaN on an unknown road
  double edge_distance = 0.0;        ///< gap of the outermost tyre to the edge [m]; NaN on an unknown road
  bool is_off_track = false;         ///< a tyre is off the road
  std::vector<Vec2> plan{};          ///< predicted positions in W [m]
  std::vector<double> plan_speed{};  ///< predicted speeds there [m/s]
};

/// Recorded run with its road.
struct DrivenRun {
  std::string track{}, controller{}, preset{};  ///< names
  double track_length = 0.0;                    ///< [m], 0: unknown
  bool is_closed = true;                        ///< the road is a circuit
  double front = 2.0, rear = 2.0,
         width = 1.9;                 ///< length of the body ahead of and behind its centre, width [m]
  double steer_limit = 0.4;           ///< largest road-wheel angle [rad]
  std::vector<Vec2> left{}, right{};  ///< edges of the road in W [m]
  std::vector<DrivenMoment> moments{};
  int last_lap = 0;  ///< number of the last completed lap; 0: none

  /// Moments of lap number `lap`, counted from 1; 0: all. Empty when there are none.
  [[nodiscard]] std::vector<DrivenMoment> of_lap(int lap) const;
};

/// Reads the last run of a recording of `drive`, `simulate` or `serve`. kParse for a file that is no
/// recording of ours or has no control step; otherwise fails as telemetry::read_mcap().
[[nodiscard]] Result<DrivenRun> read_run(const std::string& recording);

/// Options of a LapPicture.
struct PictureOptions {
  int width = 1280;          ///< [px], even; [160, 3840]
  int height = 720;          ///< [px], even; [90, 2160]
  bool shows_whole = false;  ///< show the whole road; false: follow the car
  double view = 110.0;       ///< width of the view that follows the car [m]
};

/// Draws moments of a run from above: the road, the car, its plan coloured by speed, its trace, and the car
/// of another run as a ghost. Text shows speed, lap time and the time lost to the ghost at the same place; a
/// bar shows the progress of the lap, a small map the whole road.
class LapPicture {
 public:
  /// `shown`: moments to draw, by rising time. `ghost`: moments of the other run, or empty. Both cars are
  /// shown at the same time since their own starts. `run` outlives this.
  LapPicture(const DrivenRun& run, std::vector<DrivenMoment> shown, std::vector<DrivenMoment> ghost,
             const PictureOptions& options);

  /// Duration of the pictures [s].
  [[nodiscard]] double duration() const;
  /// Picture at `time` [s] after the beginning, limited to the duration.
  [[nodiscard]] const Canvas& at(double time);
  /// Delay of the car behind the ghost at the car's place, at `time` after the beginning [s]; none if the
  /// ghost never was there.
  [[nodiscard]] std::optional<double> lost_to_ghost(double time) const;

 private:
  /// Map from W to pixels.
  struct Camera {
    Vec2 middle{};       ///< point in W that is shown at `centre` [m]
    double scale = 1.0;  ///< [px/m]
    Vec2 centre{};       ///< pixel at which `middle` is shown
    /// Pixel of a point in W.
    [[nodiscard]] Vec2 operator()(const Vec2& point) const;
  };
  /// Camera that shows the whole road within a rectangle of the picture [px].
  [[nodiscard]] Camera whole(double x, double y, double width, double height) const;
  /// Draws road and edges; `edge`: width of the edges [px].
  void draw_road(const Camera& camera, double edge);
  void draw_car(const Camera& camera, const DrivenMoment& moment, const Colour& colour);
  /// Draws the plan, coloured by its speed.
  void draw_plan(const Camera& camera, const DrivenMoment& moment);
  /// Draws the path of the car up to `time` [s].
  void draw_trace(const Camera& camera, double time);
  /// Draws the small map with both cars.
  void draw_map(const DrivenMoment& moment, const std::optional<DrivenMoment>& other);
  /// Driven share of the lap, from where it began; none on an unknown road.
  [[nodiscard]] std::optional<double> progress(const DrivenMoment& moment) const;
  /// Draws the text, and the bar of progress.
  void draw_words(const DrivenMoment& moment, double time);

  const DrivenRun& run_;
  std::vector<DrivenMoment> shown_, ghost_;  ///< moments of the car, and of the ghost
  PictureOptions options_;
  Canvas canvas_;
  double top_speed_ = 1.0;  ///< speed of the fastest colour [m/s]
};

}  // namespace chicane::recording
