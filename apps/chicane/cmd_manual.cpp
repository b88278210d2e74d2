// SPDX-License-Identifier: MIT
// `chicane manual` and `chicane completion`: the manual page, and the words that may follow on a command
// line. Both are made of the rows of options by which the command line is read.
#include <fmt/format.h>

#include <string>

#include "chicane/version.hpp"
#include "commands.hpp"
#include "option_row.hpp"

namespace chicane::apps {
namespace {

/// Text for roff (man pages), with everything escaped that roff reads as a command.
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

/// Synopsis of a command, as roff.
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

/// Entry of an option, as roff.
std::string manual_entry(const OptionRow& row) {
  std::string names;
  for (const std::string& name : row.typed_names())
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", plain(name));
  if (!row.is_flag()) names += fmt::format("{}\\fI{}\\fR", names.empty() ? "" : " ", plain(row.value));
  return fmt::format(".TP\n{}\n{}.\n", names, plain(row.meaning + notes(row)));
}

/// Sections after the commands.
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
      ".TH CHICANE 1 \"\" \"chicane {}\" \"User Commands\"\n.SH NAME\n"
      "chicane \\- drive a car round a track by model predictive control\n.SH SYNOPSIS\n",
      plain(kVersion));
  Options scratch;
  for (const Command& command : commands()) page += synopsis(command, options_of(command, scratch)) + ".br\n";
  page +=
      ".SH DESCRIPTION\nController, simulator, recorder and dashboard in one program. "
      "Results go to the standard output, everything else to the\nstandard error.\n.SH COMMANDS\n";
  for (const Command& command : commands()) {
    page += fmt::format(".SS chicane {}\n{}.\n", plain(command.name), plain(command.summary));
    for (const OptionRow& row : options_of(command, scratch)) page += manual_entry(row);
    page += fmt::format(".PP\nExample:\n.B {}\n", plain(command.example));
  }
  return page.append(kTail);
}

ExitCode manual(const Options&) {
  fmt::print("{}", manual_page());
  return kSuccess;
}

namespace {

/// Line of a candidate: a word that may follow, and its meaning.
std::string candidate(std::string_view word, std::string_view meaning) {
  return fmt::format("{}\t{}\n", word, meaning);
}

/// Candidates for the value of an option.
std::string values_of(const OptionRow& row) {
  std::string lines;
  for (const std::string& word : row.rule.words) lines += candidate(word, "");
  const bool is_assignment = row.value.find('=') != std::string_view::npos;
  if (!row.rule.shelf.empty())
    for (const ListEntry& entry : list_entries(row.rule.shelf))
      lines += candidate(entry.name + (is_assignment ? "=" : ""), entry.meaning);
  for (const char* kind : {"FILE", "LOG", "FOLDER", "SCENARIO", "PLAN", "LEAGUE"})
    if (row.value.find(kind) != std::string_view::npos) return lines + candidate("/", "");
  return lines;
}

/// Candidates after a command line. A word that ends with "=" is followed by a value; "/" stands for the
/// names of files.
std::string candidates(const std::vector<std::string>& line) {
  std::string lines = candidate("--help", "Print this help and end");
  if (line.size() == 1) {
    for (const Command& command : commands()) lines += candidate(command.name, command.summary);
    return lines + candidate("--version", "Print the version and end");
  }
  Options scratch;
  for (const Command& command : commands()) {
    if (command.name != line[1]) continue;
    for (const OptionRow& row : options_of(command, scratch)) {
      for (const std::string& name : row.typed_names()) {
        if (name == line.back() && !row.is_flag()) return values_of(row);
        lines += candidate(name, row.meaning);
      }
      if (row.is_positional()) lines += values_of(row);
    }
  }
  return lines;
}

/// Scripts of the shells, which call `chicane completion SHELL -- WORDS` for the candidates.
constexpr std::string_view kBash = R"(# bash completion for chicane, made by `chicane completion bash`.
_chicane() {
  local word meaning current=${COMP_WORDS[COMP_CWORD]}
  COMPREPLY=()
  while IFS=$'\t' read -r word meaning; do
    case $word in
      /) compopt -o filenames 2>/dev/null; mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current") ;;
      -*) [[ $current == -* && $word == "$current"* ]] && COMPREPLY+=("$word") ;;
      "$current"*=) compopt -o nospace 2>/dev/null; COMPREPLY+=("$word") ;;
      "$current"*) COMPREPLY+=("$word") ;;
    esac
  done < <("${COMP_WORDS[0]}" completion bash -- "${COMP_WORDS[@]:0:COMP_CWORD}" 2>/dev/null)
}
complete -F _chicane chicane
)";

constexpr std::string_view kZsh = R"(#compdef chicane
# zsh completion for chicane, made by `chicane completion zsh`.
_chicane() {
  local line word
  local -a found keys
  for line in "${(@f)$(_call_program candidates chicane completion zsh -- ${(q)words[1,CURRENT-1]})}"; do
    word=${line%%$'\t'*}
    case $word in
      /) _files ;;
      -*) [[ $PREFIX == -* ]] && found+="$word:${line#*$'\t'}" ;;
      *=) keys+=$word ;;
      *) found+="${word//:/\\:}:${line#*$'\t'}" ;;
    esac
  done
  compadd -S '' -a keys
  _describe value found
}
if [[ $funcstack[1] == _chicane ]]; then _chicane "$@"; else compdef _chicane chicane; fi
)";

constexpr std::string_view kFish = R"(# fish completion for chicane, made by `chicane completion fish`.
function _chicane
    chicane completion fish -- (commandline -opc) 2>/dev/null
end
complete -c chicane -f -a '(_chicane | string match -v -r "^/")'
complete -c chicane -F -n '_chicane | string match -q -r "^/"'
)";

}  // namespace

ExitCode completion(const Options& options) {
  const std::string_view script = options.shell == "zsh" ? kZsh : options.shell == "fish" ? kFish : kBash;
  fmt::print("{}", options.line.empty() ? std::string(script) : candidates(options.line));
  return kSuccess;
}

}  // namespace chicane::apps
