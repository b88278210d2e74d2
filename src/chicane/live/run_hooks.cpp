// SPDX-License-Identifier: MIT
#include "chicane/live/run_hooks.hpp"

#include <utility>

namespace chicane::live {

LiveHooks recording_hooks(recording::Recorder* recorder, RunLimit& limit) {
  if (recorder == nullptr) return {};
  return {.on_frame =
              [recorder, &limit](const telemetry::Frame& frame) {
                record_news(recorder, limit);
                recorder->record(frame);
              },
          .on_lap = [recorder](const telemetry::CompletedLap& lap) { recorder->record(lap); },
          .on_change = [recorder](const telemetry::Change& change) { recorder->record(change); }};
}

LiveHooks journal_hooks(Journal& journal) {
  return {.on_frame = [&journal](const telemetry::Frame& frame) { journal.note(frame); },
          .on_change = [&journal](const telemetry::Change& change) { journal.note(change); }};
}

void record_news(recording::Recorder* recorder, RunLimit& limit) {
  if (recorder == nullptr) return;
  if (auto news = limit.news()) recorder->record(std::move(news));
}

}  // namespace chicane::live
