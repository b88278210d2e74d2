// SPDX-License-Identifier: MIT
// `chicane manual` and `chicane completion`: the manual page and the completion scripts of three shells,
// written from the same rows of options that the command line is read by.
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

std::string manual_entry(const OptionRow& row) {
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

/// Completions for the value of an option, in any of the three shells.
struct Value {
  std::string words;           ///< fixed words, separated by blanks
  std::string shelf;           ///< argument of `chicane list`, which prints names; empty: none
  bool is_file = false;        ///< names of files
  bool is_assignment = false;  ///< KEY=VALUE: no blank after the completed key
};

Value value_of(const OptionRow& option) {
  Value value;
  value.words = fmt::format("{}", fmt::join(option.rule.words, " "));
  value.shelf = option.rule.shelf;
  for (const char* kind : {"FILE", "LOG", "FOLDER", "SCENARIO", "PLAN", "LEAGUE"})
    value.is_file = value.is_file || option.value.find(kind) != std::string_view::npos;
  value.is_assignment = option.value.find('=') != std::string_view::npos;
  return value;
}

/// Text in single quotes; `quote` replaces each single quote inside.
std::string quoted(std::string_view text, std::string_view quote) {
  std::string result;
  for (const char c : text) result += c == '\'' ? std::string(quote) : std::string(1, c);
  return "'" + result + "'";
}

std::string option_names(const Command& command) {
  Options scratch;
  std::string names = "--help";
  for (const OptionRow& option : options_of(command, scratch)) {
    if (option.is_positional()) continue;
    for (const std::string& name : option.typed_names()) names += " " + name;
  }
  return names;
}

// bash ----------------------------------------------------------------------------------------------------

constexpr std::string_view kBashHead = R"(# bash completion for chicane, made by `chicane completion bash`.
_chicane_names() { "${COMP_WORDS[0]}" list "$1" 2>/dev/null | cut -d' ' -f1; }
_chicane_words() { mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$1" -- "$current"); }
_chicane_files() { compopt -o filenames 2>/dev/null; mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current"); }
_chicane() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  COMPREPLY=()
)";

std::string bash_action(const Value& value) {
  std::string action;
  if (!value.words.empty()) action += fmt::format("_chicane_words '{}'; ", value.words);
  if (!value.shelf.empty()) action += fmt::format("_chicane_words \"$(_chicane_names {})\"; ", value.shelf);
  if (value.is_assignment) action += "compopt -o nospace 2>/dev/null; COMPREPLY=(\"${COMPREPLY[@]/%/=}\"); ";
  if (value.is_file) action += "_chicane_files; ";
  return action;
}

std::string bash_script() {
  Options scratch;
  std::string script(kBashHead);
  std::string names = "--help --version";
  for (const Command& command : commands()) names += fmt::format(" {}", command.name);
  script += fmt::format("  if ((COMP_CWORD == 1)); then _chicane_words '{}'; return; fi\n", names);
  script += "  case ${COMP_WORDS[1]} in\n";
  for (const Command& command : commands()) {
    std::string positional;
    script += fmt::format("    {})\n      case $previous in\n", command.name);
    for (const OptionRow& option : options_of(command, scratch)) {
      if (option.is_positional()) positional += bash_action(value_of(option));
      if (option.is_positional() || option.value.empty()) continue;
      script += fmt::format("        {}) {}return ;;\n", fmt::join(option.typed_names(), " | "),
                            bash_action(value_of(option)));
    }
    script += fmt::format("      esac\n      if [[ $current == -* ]]; then _chicane_words '{}'; return; fi\n",
                          option_names(command));
    script += fmt::format("      {};;\n", positional);
  }
  return script + "  esac\n}\ncomplete -F _chicane chicane\n";
}

// zsh -----------------------------------------------------------------------------------------------------

std::string zsh_action(const Value& value) {
  std::string action;
  if (value.is_assignment) return fmt::format("{{_chicane_names {} -S =}}", value.shelf);
  if (!value.words.empty()) return fmt::format("({})", value.words);
  if (!value.shelf.empty()) action = fmt::format("_chicane_names {}", value.shelf);
  if (value.is_file) action += action.empty() ? "_files" : "; _files";
  return action.empty() ? " " : "{" + action + "}";
}

/// Text quoted for zsh's _arguments, where brackets and colons mean something.
std::string zsh_text(std::string_view text) {
  std::string result;
  for (const char c : text) result += (c == '[' || c == ']' || c == ':' ? "\\" : "") + std::string(1, c);
  return result;
}

std::string zsh_script() {
  Options scratch;
  const std::string_view quote = R"('\'')";
  std::string script =
      "#compdef chicane\n# zsh completion for chicane, made by `chicane completion zsh`.\n"
      "_chicane_names() { local shelf=$1; shift; "
      "compadd \"$@\" -- ${(f)\"$(chicane list $shelf 2>/dev/null | cut -d' ' -f1)\"} }\n"
      "_chicane() {\n  if (( CURRENT == 2 )); then\n    local -a commands=(\n";
  for (const Command& command : commands())
    script += fmt::format("      {}\n",
                          quoted(fmt::format("{}:{}", command.name, zsh_text(command.summary)), quote));
  script +=
      "    )\n    _describe command commands\n    return\n  fi\n"
      "  shift words; (( CURRENT-- ))\n  case $words[1] in\n";
  for (const Command& command : commands()) {
    script +=
        fmt::format("    {})\n      _arguments '--help[Print this help message and exit]'", command.name);
    for (const OptionRow& option : options_of(command, scratch)) {
      const std::string action = zsh_action(value_of(option));
      const std::string value = ":" + zsh_text(option.value) + ":" + action;
      if (option.is_positional()) {
        script += " \\\n        " + quoted("*" + value, quote);
        continue;
      }
      for (const std::string& name : option.typed_names()) {
        script += " \\\n        " + quoted(fmt::format("*{}[{}]{}", name, zsh_text(option.meaning),
                                                       option.value.empty() ? "" : value),
                                           quote);
      }
    }
    script += " ;;\n";
  }
  return script +
         "  esac\n}\n"
         "if [[ $funcstack[1] == _chicane ]]; then _chicane \"$@\"; else compdef _chicane chicane; fi\n";
}

// fish ----------------------------------------------------------------------------------------------------

std::string fish_values(const Value& value) {
  std::string words = value.words;
  if (!value.shelf.empty()) {
    words += fmt::format("(chicane list {} 2>/dev/null | string split -f1 \" \"{})", value.shelf,
                         value.is_assignment ? " | string replace -r '$' =" : "");
  }
  return words.empty() ? "" : " -a " + quoted(words, R"(\')");
}

std::string fish_script() {
  Options scratch;
  const std::string_view quote = R"(\')";
  std::string script =
      "# fish completion for chicane, made by `chicane completion fish`.\ncomplete -c chicane -f\n"
      "complete -c chicane -n __fish_use_subcommand -l help\ncomplete -c chicane -n __fish_use_subcommand -l "
      "version\n";
  for (const Command& command : commands()) {
    script += fmt::format("complete -c chicane -n __fish_use_subcommand -a {} -d {}\n", command.name,
                          quoted(command.summary, quote));
    const std::string line =
        fmt::format("complete -c chicane -n '__fish_seen_subcommand_from {}'", command.name);
    for (const OptionRow& option : options_of(command, scratch)) {
      const Value value = value_of(option);
      script += line;
      if (!option.is_positional()) {
        for (const std::string& name : option.typed_names())
          script += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        if (!option.value.empty()) script += " -r";
      }
      script += fmt::format(" {}{} -d {}\n", value.is_file ? "-F" : "-f", fish_values(value),
                            quoted(option.meaning, quote));
    }
    script += line + " -l help\n";
  }
  return script;
}

}  // namespace

std::string completion_script(std::string_view shell) {
  if (shell == "zsh") return zsh_script();
  if (shell == "fish") return fish_script();
  return bash_script();
}

ExitCode completion(const Options& options) {
  fmt::print("{}", completion_script(options.shell));
  return kSuccess;
}

}  // namespace chicane::apps
