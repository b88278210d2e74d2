// SPDX-License-Identifier: MIT
#include "video_options.hpp"

namespace chicane::apps {

void add_video(CLI::App& command, Options& options) {
  Options::Video& video = options.video;
  command.add_option("log", options.log_files, "Recording by --record")
      ->type_name("LOG")
      ->required()
      ->expected(1);
  command
      .add_option("-o,--output", options.output_file,
                  "Film to write: .mp4, .webm, .webp or .gif; an older one is replaced")
      ->type_name("FILE")
      ->required();
  command.add_option("--ghost", video.ghost, "Recording whose car drives beside, from the same beginning")
      ->type_name("LOG");
  command
      .add_option("--lap", video.lap, "Counted from 1; 0: the whole run; the last whole lap when left out")
      ->type_name("N")
      ->check(CLI::Range(0, 1000000));
  command.add_option("--from-s", video.from, "Begin so long after the beginning of the lap [s]")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--for-s", video.length, "Show so long [s]; else to its end")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  command.add_option("--pace", video.speed, "Seconds of the run in a second of the film")
      ->type_name("X")
      ->check(CLI::Range(0.05, 50.0))
      ->capture_default_str();
  command.add_option("--rate", video.rate, "Pictures in a second")
      ->type_name("N")
      ->check(CLI::Range(1.0, 120.0))
      ->capture_default_str();
  command.add_option("--width", video.width, "Width of the picture [px]; its height is 9/16 of it")
      ->type_name("N")
      ->check([](const std::string& text) {
        int width = 0;
        const bool is_even =
            CLI::detail::lexical_cast(text, width) && width >= 160 && width <= 3840 && width % 2 == 0;
        return is_even ? std::string() : "got " + text + ", expected an even number from 160 to 3840";
      })
      ->capture_default_str();
  command.add_option("--quality", video.quality, "Quality of .webp, 1 to 100")
      ->type_name("N")
      ->check(CLI::Range(1, 100));
  command.add_flag("--whole", video.is_whole, "Show the whole road all the time, not the car from above");
  command.footer("Example: chicane video run.mcap -o lap.mp4 --ghost other.mcap");
}

}  // namespace chicane::apps
