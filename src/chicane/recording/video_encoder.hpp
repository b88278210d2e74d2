// SPDX-License-Identifier: MIT
// Encoder of films: pictures through the program ffmpeg into .mp4, .webm, .webp or .gif.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::recording {

/// Format of a film.
struct VideoFormat {
  std::string output{};            ///< file; its ending gives the format: .mp4, .webm, .webp or .gif
  int width = 1280, height = 720;  ///< size [px]
  double rate = 30.0;              ///< pictures per second
  int quality = 0;                 ///< quality of .webp, 1 to 100; 0: 60
};

/// Checks the ending of a name. kInvalidArgument lists the known endings.
[[nodiscard]] Result<void> check_video_name(const std::string& output);
/// Command line of the encoder as words; the last one is the output.
[[nodiscard]] std::vector<std::string> encoder_command(const VideoFormat& format);

/// Encodes a film by the program `ffmpeg` of the system, which gets the pictures through a socket. The film
/// is written under another name; finish() gives it its own, and without finish() it is deleted.
class VideoEncoder {
 public:
  /// Starts the encoder. kNotFound, with the package's name, without ffmpeg; kInvalidArgument for an unknown
  /// ending; kIo. finish() replaces an older file.
  [[nodiscard]] static Result<VideoEncoder> start(const VideoFormat& format);
  VideoEncoder(VideoEncoder&& other) noexcept;
  VideoEncoder& operator=(VideoEncoder&&) = delete;
  ~VideoEncoder();

  /// Adds a picture: three bytes for each pixel. kIo when ffmpeg has ended.
  [[nodiscard]] Result<void> add(std::span<const std::uint8_t> picture);
  /// Ends the film. kIo when ffmpeg failed; it prints the reason on stderr.
  [[nodiscard]] Result<void> finish();

 private:
  VideoEncoder(std::string output, std::string unfinished, int process, int pipe)
      : output_{std::move(output)}, unfinished_{std::move(unfinished)}, process_{process}, pipe_{pipe} {}

  std::string output_, unfinished_;  ///< path of the film, and of the unfinished one
  int process_;                      ///< process of ffmpeg; -1: it has ended
  int pipe_;                         ///< socket to ffmpeg; -1: closed
};

}  // namespace chicane::recording
