// SPDX-License-Identifier: MIT
// Films by the program ffmpeg: its command line, its process, and the pictures that it gets through a socket.
#include "chicane/recording/video_encoder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

extern char** environ;

namespace chicane::recording {
namespace {

std::string ending_of(const std::string& output) {
  return std::filesystem::path(output).extension().string();
}

/// Path of the unfinished film, beside the output; its ending names the format.
std::string unfinished_of(const std::string& output) {
  std::filesystem::path path(output);
  path.replace_extension(fmt::format("{}.part{}", ::getpid(), ending_of(output)));
  return path.string();
}

}  // namespace

Result<void> check_video_name(const std::string& output) {
  const std::string ending = ending_of(output);
  for (const char* known : {".mp4", ".webm", ".webp", ".gif"})
    if (ending == known) return {};
  return fail(ErrorCode::kInvalidArgument,
              fmt::format("{}: got another ending, expected .mp4, .webm, .webp or .gif", output));
}

std::vector<std::string> encoder_command(const VideoFormat& format) {
  std::vector<std::string> words{"ffmpeg",   "-loglevel",
                                 "error",    "-y",
                                 "-f",       "rawvideo",
                                 "-pix_fmt", "rgb24",
                                 "-s",       fmt::format("{}x{}", format.width, format.height),
                                 "-r",       fmt::format("{:g}", format.rate),
                                 "-i",       "pipe:0"};
  // Codecs and qualities by format; chosen by eye and size of the file.
  const std::string ending = ending_of(format.output);
  const std::string quality = std::to_string(format.quality > 0 ? format.quality : 60);
  std::vector<std::string> coding;
  if (ending == ".mp4")
    coding = {"-c:v", "libx264", "-pix_fmt", "yuv420p",   "-crf",
              "21",   "-preset", "medium",   "-movflags", "+faststart"};
  if (ending == ".webm")
    coding = {"-c:v", "libvpx-vp9", "-pix_fmt",  "yuv420p", "-crf",      "33",
              "-b:v", "0",          "-deadline", "good",    "-cpu-used", "4"};
  if (ending == ".webp")
    coding = {"-c:v",  "libwebp_anim",       "-pix_fmt", "yuv420p", "-quality",
              quality, "-compression_level", "4",        "-loop",   "0"};
  if (ending == ".gif")
    coding = {"-filter_complex", "split[a][b];[a]palettegen=max_colors=64[p];[b][p]paletteuse=dither=none",
              "-loop", "0"};
  words.insert(words.end(), coding.begin(), coding.end());
  words.push_back("file:" + format.output);
  return words;
}

Result<VideoEncoder> VideoEncoder::start(const VideoFormat& format) {
  if (const Result<void> named = check_video_name(format.output); !named) return fail(named.error());
  // Sockets rather than a pipe: writing to an encoder that has ended is then an error, not a signal.
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail(ErrorCode::kIo, fmt::format("ffmpeg: {}", std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  VideoFormat unfinished = format;
  unfinished.output = unfinished_of(format.output);
  std::vector<std::string> words = encoder_command(unfinished);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = -1;
  const int failure = ::posix_spawnp(&process, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  if (failure == 0) return VideoEncoder(format.output, unfinished.output, process, ends[1]);
  ::close(ends[1]);
  if (failure == ENOENT)
    return fail(ErrorCode::kNotFound,
                "ffmpeg: got none, expected the program in the path (Debian: apt-get install ffmpeg)");
  return fail(ErrorCode::kIo, fmt::format("ffmpeg: {}", std::strerror(failure)));
}

VideoEncoder::VideoEncoder(VideoEncoder&& other) noexcept
    : output_{std::move(other.output_)},
      unfinished_{std::move(other.unfinished_)},
      process_{std::exchange(other.process_, -1)},
      pipe_{std::exchange(other.pipe_, -1)} {}

VideoEncoder::~VideoEncoder() {
  if (pipe_ >= 0) ::close(pipe_);
  if (process_ < 0) return;
  ::waitpid(process_, nullptr, 0);
  std::error_code error;  // ignored: it may not exist yet
  std::filesystem::remove(unfinished_, error);
}

Result<void> VideoEncoder::add(std::span<const std::uint8_t> picture) {
  while (!picture.empty()) {
    const ssize_t sent = ::send(pipe_, picture.data(), picture.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return fail(ErrorCode::kIo, fmt::format("{}: ffmpeg has ended", output_));
    picture = picture.subspan(static_cast<std::size_t>(sent));
  }
  return {};
}

Result<void> VideoEncoder::finish() {
  ::close(std::exchange(pipe_, -1));
  int status = 0;
  ::waitpid(std::exchange(process_, -1), &status, 0);
  std::error_code error;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    std::filesystem::rename(unfinished_, output_, error);
    if (!error) return {};
  }
  std::filesystem::remove(unfinished_, error);
  return fail(ErrorCode::kIo, fmt::format("{}: ffmpeg could not write it", output_));
}

}  // namespace chicane::recording
