// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "chicane/base/result.hpp"
#include "chicane/sweep/plan.hpp"

namespace chicane::sweep {

/// Reads a plan (docs/sweep.md has the grammar):
///
///     name: dt at lower speed
///     settings: {preset: fast-short-step, laps: 3}    # of all runs, as in a preset
///     axes:                                           # each run has one value of each
///       - speed_mph: [30, 40, 50]                     # a list
///       - track: [oval, ../tracks/*.csv]              # of tracks also a folder
///       - cubic_mpc.step_length_s: {from: 0.02, to: 0.2, count: 10, scale: log}
///       - cubic_mpc.horizon_steps: [125, 25]          # two keys of one axis change together
///         cubic_mpc.step_length_s: [0.005, 0.025]
///       - sample: {method: sobol, count: 64, seed: 3} # or latin-hypercube: ranges and lists are filled
///       evenly
///         latency_ms: {from: 50, to: 150}
///       - grip: {cases: {dry: {}, wet: {plant_options.friction_scale: 0.7}}}  # names for settings
///     search: {speed_mps: {from: 5, to: 80}}          # each run looks for its largest clean value
///     marks: [{speed_mph: 40, grip: dry}]             # places that the maps of the report mark
///     keep: [lap_time_s, off_track_events]            # columns; all when left out
///
/// kParse lists all faults, each with its line: unknown keys, values that no run could take, plans of more
/// than Plan::kMostRuns. Memory and time stay bounded, whatever the bytes (protocol/yaml_tree.hpp).
[[nodiscard]] Result<Plan> parse_plan(std::string_view text, const std::string& file);

/// The same of a file; kNotFound when there is none.
[[nodiscard]] Result<Plan> read_plan(const std::string& file);

}  // namespace chicane::sweep
