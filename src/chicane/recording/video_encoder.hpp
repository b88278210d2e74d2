// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "chicane/base/result.hpp"

namespace chicane::recording {

struct VideoFormat {
  std::string output{};  ///< its ending says what it becomes: .mp4, .webm, .webp or .gif
  int width = 1280, height = 720;
  double rate = 30.0;  ///< pictures in a second
  int quality = 0;     ///< of .webp, 1 to 100; 0: 60
};

/// Whether there is such an ending. kInvalidArgument names those there are.
[[nodiscard]] Result<void> check_video_name(const std::string& output);
/// The words of the command that encodes; the last one is the output.
[[nodiscard]] std::vector<std::string> encoder_command(const VideoFormat& format);

/// A film under construction: the program `ffmpeg` of the system, fed with pictures through a pipe. What it
/// writes takes its name in finish(); without, nothing is left of it.
class VideoEncoder {
 public:
  /// kNotFound with the package's name where there is no ffmpeg; kInvalidArgument for another ending; kIo.
  /// An older file is replaced in the end.
  [[nodiscard]] static Result<VideoEncoder> start(const VideoFormat& format);
  VideoEncoder(VideoEncoder&& other) noexcept;
  VideoEncoder& operator=(VideoEncoder&&) = delete;
  ~VideoEncoder();

  /// One picture: three bytes for each pixel. kIo when ffmpeg has ended.
  [[nodiscard]] Result<void> add(std::span<const std::uint8_t> picture);
  /// kIo when ffmpeg says that something failed; its own words stand on stderr.
  [[nodiscard]] Result<void> finish();

 private:
  VideoEncoder(std::string output, std::string unfinished, int process, int pipe)
      : output_{std::move(output)}, unfinished_{std::move(unfinished)}, process_{process}, pipe_{pipe} {}

  std::string output_, unfinished_;
  int process_;  ///< -1: it has ended
  int pipe_;
};

}  // namespace chicane::recording
