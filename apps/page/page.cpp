// SPDX-License-Identifier: MIT
// Run inside a worker of a browser, without a server program: functions that worker.js calls.
#include <emscripten.h>
#include <link.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "chicane/live/worker_run.hpp"
#include "chicane/protocol/library.hpp"
#include "chicane/protocol/track_codec.hpp"
#include "chicane/protocol/yaml_tree.hpp"
#include "chicane/run/closed_loop.hpp"

namespace chicane::protocol {

// Replacements for protocol/foreign_tracks.cpp and yaml_tree.cpp: the page reads its own files only, and has
// no library for images, XML and YAML.
std::span<const TrackFormat> foreign_tracks() noexcept { return {}; }
std::string_view road_kind(std::string_view) noexcept { return "table of points"; }
Result<YamlTree> parse_yaml(std::string_view text, const std::string& file) {
  return parse_plain_yaml(text, file);
}

}  // namespace chicane::protocol

namespace chicane {

// Replacements for recording/recorder.cpp, live/run_log.cpp and live/run_limit.cpp, which a page does not
// use: nothing calls them.
void recording::Recorder::record(const telemetry::Frame&) noexcept {}
void recording::Recorder::record(const telemetry::CompletedLap&) noexcept {}
void recording::Recorder::record(const telemetry::Change&) noexcept {}
void recording::Recorder::record(std::shared_ptr<const lap_time::LimitAnswer>) noexcept {}
void live::RunLog::note(const telemetry::Frame&) noexcept {}
std::shared_ptr<const lap_time::LimitAnswer> live::RunLimit::news() noexcept { return nullptr; }

}  // namespace chicane

/// Replacement for the list of loaded libraries: a page has none.
extern "C" int dl_iterate_phdr(int (*)(dl_phdr_info*, std::size_t, void*), void*) { return 0; }

using namespace chicane;

// Hands a message for the page to worker.js.
EM_JS(void, post_to_page, (const char* bytes, int size, bool binary),
      { Module.postToPage(HEAPU8.slice(bytes, bytes + size), binary); });

namespace {

std::unique_ptr<live::WorkerRun> worker_run;  // null before page_begin()
std::string answer;                           // result of the last call that returns a text

/// Keeps a text for worker.js, valid until the next call.
const char* tell(std::string text) {
  answer = std::move(text);
  return answer.c_str();
}

/// Bytes of worker.js as text.
std::string_view view(const char* bytes, int size) { return {bytes, static_cast<std::size_t>(size)}; }

}  // namespace

extern "C" {

/// Begins a run as `chicane drive` would. Returns the fault, or an empty text.
EMSCRIPTEN_KEEPALIVE const char* page_begin() {
  const auto scenario = protocol::compose({});
  if (!scenario) return tell(scenario.error().message);
  auto run = live::WorkerRun::create(*scenario, [](std::string_view bytes, bool binary) {
    post_to_page(bytes.data(), static_cast<int>(bytes.size()), binary);
  });
  if (!run) return tell(run.error().message);
  worker_run = std::move(*run);
  return tell("");
}

/// Begins the connection with the page. Pre, here and below: page_begin() was successful.
EMSCRIPTEN_KEEPALIVE void page_connect() { worker_run->connect(); }

/// Takes a message from the page.
EMSCRIPTEN_KEEPALIVE void page_receive(const char* bytes, int size, bool binary) {
  worker_run->receive(view(bytes, size), binary);
}

/// Takes in that the page has processed `count` messages.
EMSCRIPTEN_KEEPALIVE void page_acknowledge(int count) {
  worker_run->acknowledge(static_cast<std::size_t>(count));
}

/// Content of a page of the run, such as "/schema.json"; null if there is none.
EMSCRIPTEN_KEEPALIVE const char* page_get(const char* path) {
  const std::optional<net::Content> content = worker_run->get(path);
  if (!content) return nullptr;
  return tell(content->shared ? *content->shared : content->bytes);
}

/// Drives up to the run's time at `now` [s], for at most `patience` [s] of the clock.
EMSCRIPTEN_KEEPALIVE void page_advance(double now, double patience) {
  const double end = emscripten_get_now() + 1e3 * patience;
  worker_run->advance(now, [end] { return emscripten_get_now() < end; });
}
}
