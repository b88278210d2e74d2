// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <string>

#include "chicane/version.hpp"
#include "commands.hpp"
#include "option_row.hpp"

namespace chicane::apps {
namespace {

/// As roff text: no character of it is a command.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '-') {
      result += "\\-";
    } else if (c == '\\') {
      result += "\\e";
    } else {
      result += c;
    }
  }
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string synopsis(const Command& command, const Rows& rows) {
  std::string line = fmt::format(".B chicane {}\n", plain(command.name));
  std::string positionals;
  bool has_options = false;
  for (const OptionRow& row : rows) {
    has_options = has_options || !row.is_positional();
    if (!row.is_positional()) continue;
    const std::string value = fmt::format("\\fI{}\\fR{}", plain(row.value), row.takes_several() ? "..." : "");
    positionals += row.rule.is_required ? value + "\n" : "[" + value + "]\n";
  }
  return line + (has_options ? "[\\fIOPTION\\fR]...\n" : "") + positionals;
}

std::string entry(const OptionRow& row) {
  std::string names;
  for (const std::string& name : row.typed_names())
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", plain(name));
  if (!row.is_flag()) names += fmt::format("{}\\fI{}\\fR", names.empty() ? "" : " ", plain(row.value));
  return fmt::format(".TP\n{}\n{}.\n", names, plain(row.meaning + notes(row)));
}

constexpr std::string_view kTail = R"(.SH EXIT STATUS
.TP
.B 0
success
.TP
.B 1
the run failed: it left the road, or did not do all its laps; replay: a command came out different
.TP
.B 2
wrong usage, or a bad input file
.TP
.B 3
the environment: port in use, no permission
.SH ENVIRONMENT
.TP
.B CHICANE_DATA_DIR
a folder with presets, cars, tracks and scenarios to look in before those that were installed
.TP
.B CHICANE_SIMD
the instruction set that solvers use: baseline, avx2, avx512 or neon; the best one of the processor by default
.SH FILES
.TP
.I ./presets ./cars ./tracks ./scenarios
files found by name before all others
.TP
.I ../share/chicane
the same folders as installed, seen from the folder of the program
)";

}  // namespace

std::string manual_page() {
  std::string page = fmt::format(
      ".TH CHICANE 1 \"\" \"chicane {}\" \"User Commands\"\n.SH NAME\nchicane \\- drive a car round a track "
      "by "
      "model predictive control\n.SH SYNOPSIS\n",
      plain(kVersion));
  Options scratch;
  for (const Command& command : commands()) page += synopsis(command, options_of(command, scratch)) + ".br\n";
  page +=
      ".SH DESCRIPTION\nController, simulator, recorder and dashboard in one program. Results go to the "
      "standard output, "
      "everything else to the\nstandard error.\n.SH COMMANDS\n";
  for (const Command& command : commands()) {
    page += fmt::format(".SS chicane {}\n{}.\n", plain(command.name), plain(command.summary));
    for (const OptionRow& row : options_of(command, scratch)) page += entry(row);
    page += fmt::format(".PP\nExample:\n.B {}\n", plain(command.example));
  }
  return page.append(kTail);
}

ExitCode manual(const Options&) {
  fmt::print("{}", manual_page());
  return kSuccess;
}

}  // namespace chicane::apps
