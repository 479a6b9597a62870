#include "cli/completion.h"

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include "cli/client_commands.h"

namespace hyades::cli {
namespace {

// The scripts ask the program itself (--help) for commands and options, and list those that want
// the name of a job (@jobs@) or of a worker (@workers@) from cli/client_commands.h.

// Names of jobs and workers are others' words: what Bash's compgen -W is given it expands, commands
// and all, and what it offers goes to the command line as it is.
constexpr std::string_view kBash = R"sh(_hyades_offer() {
  local line
  while IFS= read -r line; do
    if [[ $line == "$1"* ]]; then COMPREPLY+=("$(printf %q "$line")"); fi
  done
}
_hyades() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} program=${COMP_WORDS[0]}
  COMPREPLY=()
  if [ "$COMP_CWORD" = 1 ]; then
    _hyades_offer "$word" < <("$program" --help 2>/dev/null | sed -nE '/^examples:/q;s/^  ([a-z-]+) .*/\1/p')
  elif [[ $word == -* ]]; then
    _hyades_offer "$word" < <("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE -- '--[a-z][a-z-]*' | sort -u)
  elif [ "${COMP_WORDS[1]}" = completion ]; then
    _hyades_offer "$word" < <(printf '%s\n' bash zsh fish)
  elif [ "${COMP_WORDS[1]}" = help ]; then
    _hyades_offer "$word" < <("$program" --help 2>/dev/null | sed -nE '/^examples:/q;s/^  ([a-z-]+) .*/\1/p')
  elif [[ $before == --* ]]; then
    _hyades_offer "$word" < <("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | sed -nE "s/^.*$before ([a-z]+(\|[a-z]+)+)( .*)?$/\1/p" | tr '|' '\n')
  elif [[ " @jobs@ " == *" ${COMP_WORDS[1]} "* ]]; then
    _hyades_offer "$word" < <(timeout 2 "$program" jobs --all --names --for "${COMP_WORDS[1]}" 2>/dev/null)
  elif [[ " @workers@ " == *" ${COMP_WORDS[1]} "* ]]; then
    _hyades_offer "$word" < <(timeout 2 "$program" workers --names 2>/dev/null)
  elif [[ " ${COMP_WORDS[1]} ${COMP_WORDS[2]} " == " media "@(show|swatch)" " && $COMP_CWORD -gt 2 ]]; then
    _hyades_offer "$word" < <("$program" media list 2>/dev/null | sed -nE '2,$s/ .*//p')
  elif [ "$COMP_CWORD" = 2 ]; then
    _hyades_offer "$word" < <("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | sed -nE '/^(Subcommands|SUBCOMMANDS):/,/^$/s/^  ([a-z-]+) .*/\1/p')
  fi
}
complete -o default -F _hyades hyades
)sh";

constexpr std::string_view kZsh = R"sh(#compdef hyades
_hyades() {
  local program=${words[1]}
  if (( CURRENT == 2 )); then
    local -a commands
    commands=(${(f)"$("$program" --help 2>/dev/null | sed -nE '/^examples:/q;s/^  ([a-z-]+) +(.*)/\1:\2/p')"})
    _describe command commands
  elif [[ ${words[CURRENT]} == -* ]]; then
    local -a options
    options=(${(f)"$("$program" "${words[2]}" --help 2>/dev/null | grep -oE -- '--[a-z][a-z-]*' | sort -u)"})
    compadd -- $options
  elif [[ ${words[2]} == completion ]]; then
    compadd bash zsh fish
  elif [[ ${words[CURRENT-1]} == --* ]]; then
    local -a values
    values=(${(s:|:)"$("$program" "${words[2]}" --help 2>/dev/null | sed -nE "s/^.*${words[CURRENT-1]} ([a-z]+(\|[a-z]+)+)( .*)?$/\1/p")"})
    if (( ${#values} )); then compadd -- $values; else _files; fi
  elif [[ " @jobs@ " == *" ${words[2]} "* ]]; then
    compadd -- ${(f)"$(timeout 2 "$program" jobs --all --names --for "${words[2]}" 2>/dev/null)"}
  elif [[ " @workers@ " == *" ${words[2]} "* ]]; then
    compadd -- ${(f)"$(timeout 2 "$program" workers --names 2>/dev/null)"}
  elif [[ ${words[2]} == media && ${words[3]} == (show|swatch) ]] && (( CURRENT > 3 )); then
    compadd -- ${(f)"$("$program" media list 2>/dev/null | sed -nE '2,$s/ .*//p')"}
    _files
  else
    local -a verbs
    (( CURRENT == 3 )) && verbs=(${(f)"$("$program" "${words[2]}" --help 2>/dev/null | sed -nE '/^(Subcommands|SUBCOMMANDS):/,/^$/s/^  ([a-z-]+) +(.*)/\1:\2/p')"})
    if (( ${#verbs} )); then _describe command verbs; else _files; fi
  fi
}
# The file of a function is read when it is first wanted, and then it is to complete at once.
if [[ ${funcstack[1]} == _hyades ]]; then _hyades "$@"; else compdef _hyades hyades; fi
)sh";

constexpr std::string_view kFish = R"sh(function __hyades_commands
  hyades --help 2>/dev/null | sed -nE '/^examples:/q;s/^  ([a-z-]+) +(.*)/\1\t\2/p'
end
function __hyades_verbs
  set -l words (commandline -opc)
  hyades $words[2] --help 2>/dev/null | sed -nE '/^(Subcommands|SUBCOMMANDS):/,/^$/s/^  ([a-z-]+) +(.*)/\1\t\2/p'
end
function __hyades_options
  set -l words (commandline -opc)
  hyades $words[2] --help 2>/dev/null | grep -oE -- '--[a-z][a-z-]*' | sort -u
end
complete -c hyades -n 'test (count (commandline -opc)) -eq 1' -f -a '(__hyades_commands)'
complete -c hyades -n 'test (count (commandline -opc)) -eq 2' -a '(__hyades_verbs)'
complete -c hyades -n 'test (count (commandline -opc)) -gt 1; and string match -q -- "-*" (commandline -ct)' -f -a '(__hyades_options)'
complete -c hyades -n '__fish_seen_subcommand_from @jobs@' -f -a '(timeout 2 hyades jobs --all --names --for (commandline -opc)[2] 2>/dev/null)'
complete -c hyades -n '__fish_seen_subcommand_from @workers@' -f -a '(timeout 2 hyades workers --names 2>/dev/null)'
complete -c hyades -n '__fish_seen_subcommand_from media; and __fish_seen_subcommand_from show swatch' -a '(hyades media list 2>/dev/null | sed -nE "2,\$s/ .*//p")'
complete -c hyades -n '__fish_seen_subcommand_from completion' -f -a 'bash zsh fish'
)sh";

enum class About { none, job, worker };

/// The words of all commands that want the name of such a thing.
std::string words_of(About wanted) {
  std::string words;
  const auto add = [&](const char* word, About about) {
    if (about == wanted) words += (words.empty() ? "" : " ") + std::string(word);
  };
#define HYADES_ADD(word, about, help) add(#word, About::about);
  HYADES_CLIENT_COMMANDS(HYADES_ADD)
#undef HYADES_ADD
  return words;
}

std::string filled_in(std::string_view script) {
  std::string text(script);
  const auto fill = [&](std::string_view mark, const std::string& words) {
    for (size_t at = 0; (at = text.find(mark, at)) != std::string::npos; at += words.size()) {
      text.replace(at, mark.size(), words);
    }
  };
  fill("@jobs@", words_of(About::job));
  fill("@workers@", words_of(About::worker));
  return text;
}

}  // namespace

int completion_command(int argc, char** argv) {
  const std::string shell = argc > 1 ? argv[1] : "";
  const std::string script = filled_in(shell == "bash"   ? kBash
                                       : shell == "zsh"  ? kZsh
                                       : shell == "fish" ? kFish
                                                         : "");
  const bool help = shell == "--help" || shell == "-h";
  if (script.empty()) {
    std::fprintf(help ? stdout : stderr,
                 "usage: hyades completion bash|zsh|fish\n"
                 "prints a script for that shell; in bash: source <(hyades completion bash)\n"
                 "examples:\n"
                 "  hyades completion bash\n"
                 "  hyades completion fish\n"
                 "exit status: 0 printed, 2 there is no such shell\n");
    return help ? 0 : 2;
  }
  std::fwrite(script.data(), 1, script.size(), stdout);
  return 0;
}

}  // namespace hyades::cli
