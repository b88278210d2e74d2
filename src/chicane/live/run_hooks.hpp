// SPDX-License-Identifier: MIT
#pragma once

#include "chicane/live/journal.hpp"
#include "chicane/live/run_limit.hpp"
#include "chicane/live/run_publisher.hpp"
#include "chicane/recording/recorder.hpp"

namespace chicane::live {

/// Records a run and, when there are news of it, its limit. All outlive the hooks; no recorder: no hooks.
[[nodiscard]] LiveHooks recording_hooks(recording::Recorder* recorder, RunLimit& limit);
/// Notes a run in its journal, which outlives the hooks.
[[nodiscard]] LiveHooks journal_hooks(Journal& journal);

/// The limit into the recording, when there are news of it. `recorder` may be null.
void record_news(recording::Recorder* recorder, RunLimit& limit);

}  // namespace chicane::live
