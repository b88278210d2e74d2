// SPDX-License-Identifier: MIT
#include "bench_options.hpp"

namespace chicane::apps {
namespace {

constexpr int kLongestHorizon =
    200;  ///< limit of bench/problems/reference.hpp, which is not part of this program

}  // namespace

void add_bench(CLI::App& command, Options& options) {
  command
      .add_option("--instances", options.instances,
                  "Problems of each family and horizon; ours solves ten times as many")
      ->type_name("N")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command.add_option("--horizons", options.horizons, "Numbers of intervals, with commas")
      ->type_name("N,...")
      ->delimiter(',')
      ->check(CLI::Range(2, kLongestHorizon))
      ->capture_default_str();
  command
      .add_option("--reference", options.reference_folder,
                  "Folder of recorded problems with known optima (lap_*.csv, golden_*.csv)")
      ->type_name("FOLDER");
  command.add_flag("--json", options.is_json, "Print one JSON object on stdout, all else on stderr");
  command.footer("Example: chicane bench --instances 200 --horizons 10,20");
}

}  // namespace chicane::apps
