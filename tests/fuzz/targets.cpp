// SPDX-License-Identifier: MIT
#include "fuzz/targets.hpp"

#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <variant>

#include "chicane/identify/detail/log_rows.hpp"
#include "chicane/identify/drive_log.hpp"
#include "chicane/net/server.hpp"
#include "chicane/protocol/foxglove_codec.hpp"
#include "chicane/protocol/ros_messages.hpp"
#include "chicane/protocol/step_codec.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/protocol/udacity_codec.hpp"
#include "chicane/protocol/yaml_codec.hpp"
#include "chicane/recording/replay.hpp"
#include "chicane/survey/free_space.hpp"
#include "chicane/survey/image.hpp"
#include "chicane/sweep/claim.hpp"
#include "chicane/sweep/league.hpp"
#include "chicane/sweep/plan_codec.hpp"
#include "net/raw_socket.hpp"

namespace chicane::fuzz {
namespace {

void promise(bool is_kept) {
  if (!is_kept) std::abort();
}

/// A message of at most a few sentences that begins as ours do.
void check(const Error& error) { promise(!error.message.empty() && error.message.size() < 100'000); }

void telemetry(std::string_view bytes) {
  const protocol::UdacityTelemetry told = protocol::parse_telemetry(bytes);
  if (const auto* measurement = std::get_if<model::Measurement>(&told)) {
    promise(std::isfinite(measurement->x) && std::isfinite(measurement->y) &&
            std::isfinite(measurement->psi) && std::isfinite(measurement->speed) &&
            measurement->waypoint_count >= 0 &&
            measurement->waypoint_count <= model::Measurement::kMaxWaypoints);
  }
  if (const auto* broken = std::get_if<protocol::UdacityBroken>(&told)) promise(!broken->reason.empty());
  const protocol::UdacityReply reply = protocol::parse_reply(bytes);
  if (const auto* steer = std::get_if<protocol::UdacitySteer>(&reply)) {
    promise(std::isfinite(steer->command.steer) && std::fabs(steer->command.throttle) <= 1.0);
  }
}

/// The first byte says whether the message is a binary one.
void viewer(std::string_view bytes) {
  if (bytes.empty()) return;
  const auto message = protocol::foxglove::parse(bytes.substr(1), (bytes[0] & 1) != 0);
  if (!message) return check(message.error());
  if (const auto* call = std::get_if<protocol::foxglove::CallService>(&*message))
    static_cast<void>(protocol::decode_set_bool(call->payload));
}

/// A server that sends back what viewers say.
class Echo {
 public:
  Echo() {
    net::ServerHandlers handlers;
    handlers.on_start = [this](net::Server& server) { server_ = &server; };
    handlers.on_upgrade = [](const net::UpgradeRequest&) { return net::UpgradeAnswer{.accept = true}; };
    handlers.on_open = [](net::ConnectionId, int) {};
    handlers.on_message = [this](net::ConnectionId id, int, std::string_view text, bool binary) {
      server_->send(id, std::string(text), binary);
    };
    handlers.on_close = [](net::ConnectionId, int, std::string_view) {};
    handlers.on_get = [](std::string_view path) -> std::optional<net::Content> {
      if (path != "/page") return std::nullopt;
      return net::Content{.content_type = "text/plain", .bytes = std::string(1000, 'x')};
    };
    auto server = net::Server::create({.port = 0, .token = "secret"}, std::move(handlers), {});
    promise(server.has_value());
    owner_ = std::move(*server);
  }
  [[nodiscard]] std::uint16_t port() const { return owner_->port(); }

 private:
  net::Server* server_ = nullptr;
  std::unique_ptr<net::Server> owner_;
};

/// A connection, after a good handshake where that is wanted. Tried twice: a busy machine may be late once, a
/// server that has lost places stays without.
test::RawSocket connected(std::uint16_t port, bool is_upgraded) {
  for (int attempt = 1;; ++attempt) {
    test::RawSocket socket(port);
    socket.forget_when_closed();
    if (!is_upgraded) return socket;
    socket.send(test::unity_handshake(port));
    const std::string answer = socket.until("\r\n\r\n");
    if (answer.starts_with("HTTP/1.1 101")) return socket;
    std::fprintf(stderr, "no handshake: %s\n", answer.c_str());
    promise(attempt < 2);
  }
}

/// The first byte says whether the rest is a request, or what a viewer sends after a good one.
void http(std::string_view bytes) {
  static const Echo echo;
  if (bytes.empty()) return;
  test::RawSocket socket = connected(echo.port(), (bytes[0] & 1) != 0);
  socket.send(bytes.substr(1));
  socket.end();
  static_cast<void>(socket.rest());
}

void yaml(std::string_view bytes) {
  const auto document = protocol::parse_document(bytes, "f");
  if (!document) return check(document.error());
  scenario::Scenario scenario;
  const std::array layers{*document};
  if (const auto applied = protocol::apply_layers(layers, scenario); !applied) return check(applied.error());
  promise(protocol::parse_document(protocol::write_document(scenario, "fuzz", true), "f").has_value());
}

void track(std::string_view bytes) {
  const auto file = protocol::parse_track(bytes, "f.csv");
  if (!file) {
    promise(file.error().message.starts_with("f.csv:") &&
            file.error().message.find("got ") != std::string::npos);
    return check(file.error());
  }
  for (const road::TrackPoint& point : file->points)
    promise(point.position.is_finite() && std::isfinite(point.left + point.right));
  constexpr std::size_t kQuick = 200;  // points; more take longer and say nothing new
  if (file->points.size() > kQuick) return;
  const auto made = protocol::make_track(*file);
  if (!made) return check(made.error());
  promise(std::isfinite(made->centre().length()) && made->centre().length() > 0.0);
}

/// The image of an occupancy map, and the road in it.
void map(std::string_view bytes) {
  const auto image = survey::read_image(bytes, "f.png");
  if (!image) return check(image.error());
  constexpr std::size_t kQuick = 40'000;  // cells
  const std::size_t cells = static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height);
  promise(image->values.size() == cells);
  if (cells > kQuick) return;
  survey::FreeSpace space{.width = image->width, .height = image->height, .resolution = 0.1};
  for (const char value : image->values) {
    const int grey = static_cast<unsigned char>(value);
    space.cells.push_back(grey > 220  ? survey::Cell::kFree
                          : grey < 90 ? survey::Cell::kWall
                                      : survey::Cell::kUnknown);
  }
  const auto loop = survey::find_loop(space, {});
  if (!loop) return check(loop.error());
  for (const road::TrackPoint& point : loop->points)
    promise(point.position.is_finite() && point.left > 0.0 && point.right > 0.0 &&
            std::isfinite(point.left + point.right));
}

/// A file of bytes that is in memory alone.
class MemoryFile {
 public:
  MemoryFile() : file_{::memfd_create("fuzz", MFD_CLOEXEC)} { promise(file_ >= 0); }
  std::string holding(std::string_view bytes) const {
    promise(::ftruncate(file_, 0) == 0);
    promise(::pwrite(file_, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
    return "/proc/self/fd/" + std::to_string(file_);
  }

 private:
  int file_;
};

/// A file of bytes in the folder for temporary files: SQLite follows links, and finds none in memory.
class DiskFile {
 public:
  DiskFile()
      : path_{
            (std::filesystem::temp_directory_path() / ("chicane_fuzz_" + std::to_string(::getpid()) + ".db3"))
                .string()} {}
  ~DiskFile() { std::remove(path_.c_str()); }
  DiskFile(const DiskFile&) = delete;
  DiskFile& operator=(const DiskFile&) = delete;
  const std::string& holding(std::string_view bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
    return path_;
  }

 private:
  std::string path_;
};

/// A bag of rosbag2 in SQLite.
void bag(std::string_view bytes) {
  static const DiskFile file;
  const auto rows = identify::read_sqlite_rows(file.holding(bytes), {});
  if (!rows) return check(rows.error());
  promise(!rows->samples.empty() && !rows->commands.empty());
}

void log(std::string_view bytes) {
  const auto logs = identify::parse_csv_log(std::string(bytes), "f.csv", {});
  if (!logs) return check(logs.error());
  for (const identify::DriveLog& log : *logs) {
    promise(!log.samples.empty() && !log.commands.empty());
    for (std::size_t i = 1; i < log.samples.size(); ++i)
      promise(log.samples[i].time > log.samples[i - 1].time && std::isfinite(log.samples[i].psi));
  }
}

void mcap(std::string_view bytes) {
  static const MemoryFile file;
  recording::RecordingHead head;
  const auto read = recording::read_recording(file.holding(bytes), head,
                                              [](const recording::RecordedEvent&) { return Result<void>{}; });
  if (!read) check(read.error());
}

/// Messages of recordings and viewers in CDR. The first byte says which.
void cdr(std::string_view bytes) {
  if (bytes.empty()) return;
  const std::string_view message = bytes.substr(1);
  switch (bytes[0] & 3) {
    case 0:
      if (const auto step = protocol::decode_step(message)) {
        promise(step->measurement.waypoint_count >= 0 &&
                step->measurement.waypoint_count <= model::Measurement::kMaxWaypoints);
        promise(static_cast<std::size_t>(step->rung) < controller::kRungCount);
      }
      return;
    case 1:
      if (const auto change = protocol::decode_change(message)) {
        const std::string again =
            protocol::encode_change(change->time, change->cycle, change->name.view(), change->value.view());
        const auto same = protocol::decode_change(again);
        promise(same && same->cycle == change->cycle && same->name.view() == change->name.view() &&
                same->value.view() == change->value.view());
      }
      return;
    case 2:
      if (const auto text = protocol::decode_ask(message)) promise(text->size() < message.size());
      return;
    default:
      static_cast<void>(protocol::decode_set_bool(message));
  }
}

/// Plans, leagues and claims. The first byte says which.
void plan(std::string_view bytes) {
  if (bytes.empty()) return;
  const std::string_view text = bytes.substr(1);
  if ((bytes[0] & 3) == 0) {
    const auto read = sweep::parse_plan(text, "f.yaml");
    if (!read) return check(read.error());
    promise(read->size() <= sweep::Plan::kMostRuns);
    for (const std::uint64_t run : {std::uint64_t{0}, read->size() / 2, read->size() - 1})
      promise(!read->settings_of(run).empty() || read->axes.empty());
  } else if ((bytes[0] & 3) == 1) {
    const auto league = sweep::parse_league(text, "f.yaml");
    if (!league) return check(league.error());
    for (const sweep::ExternalTrial& trial : league->external_trials())
      promise(!trial.why_not.empty() || !sweep::filled(trial, 4567).empty());
  } else if (const auto claims = sweep::parse_claims(text, "f.yaml"); !claims) {
    check(claims.error());
  }
}

constexpr std::array kTargets{
    Target{"telemetry", telemetry}, Target{"viewer", viewer}, Target{"http", http}, Target{"yaml", yaml},
    Target{"track", track},         Target{"log", log},       Target{"map", map},   Target{"bag", bag},
    Target{"mcap", mcap},           Target{"cdr", cdr},       Target{"plan", plan}};

}  // namespace

std::span<const Target> targets() noexcept { return kTargets; }

const Target* find(std::string_view name) noexcept {
  const auto* const found =
      std::find_if(kTargets.begin(), kTargets.end(), [&](const Target& each) { return each.name == name; });
  return found == kTargets.end() ? nullptr : found;
}

}  // namespace chicane::fuzz
