#!/usr/bin/env bash
# The installed program, moved: it finds its data beside itself and nothing of the source tree or the build.
#   program.sh PREFIX SOURCE_FOLDER BUILD_FOLDER BUILD_TYPE
set -euo pipefail
prefix=$1 source=$2 build=$3 type=$4
fail() { echo "$1"; exit 1; }
unset CHICANE_DATA_DIR
cd /

if [ "$type" = Release ]; then  # others have it in what is for the debugger
  for folder in "$source" "$build"; do
    if found=$(grep -rlF "$folder/" "$prefix"); then fail "these know $folder: $found"; fi
  done
fi

program=$prefix/bin/chicane
tracks() { "$program" list tracks | cut -d' ' -f1 | sort | tr '\n' ' '; }
before=$(tracks)
[[ $before == *lakeside* && $before == *oval* ]] || fail "got the tracks $before"
mv "$prefix/share/chicane/tracks/oval.csv" "$prefix/share/chicane/tracks/ellipse.csv"
after=$(tracks)
mv "$prefix/share/chicane/tracks/ellipse.csv" "$prefix/share/chicane/tracks/oval.csv"
[[ $after == *ellipse* && $after != *oval* ]] || fail "got the tracks $after after one was renamed"
"$program" drive --fast --laps 1

# What is installed about the program is what the program says now.
man=$prefix/share/man/man1/chicane.1
cmp "$man" <("$program" manual) || fail "the installed manual page is not the program's"
cmp "$prefix/share/bash-completion/completions/chicane.bash" <("$program" completion bash)
cmp "$prefix/share/zsh/site-functions/_chicane" <("$program" completion zsh)
cmp "$prefix/share/fish/vendor_completions.d/chicane.fish" <("$program" completion fish)

# Alone, without its data: it names each folder that it has searched.
alone=$(mktemp -d)
trap 'rm -rf "$alone"' EXIT
mkdir "$alone/bin"
cp "$program" "$alone/bin"
if [ ! -e /usr/share/chicane ] && [ ! -e /usr/local/share/chicane ]; then
  for command in 'drive --fast --laps 1' 'list tracks'; do
    code=0
    # shellcheck disable=SC2086
    said=$(CHICANE_DATA_DIR=/none "$alone/bin/chicane" $command 2>&1) || code=$?
    [ "$code" -eq 2 ] || fail "$command without data ended with $code: $said"
    for place in ./tracks /none/tracks {"$alone/bin","$alone",/usr}/share/chicane/tracks; do
      [[ $said == *"$place"* ]] || fail "$command without data does not name $place: $said"
    done
  done
fi
# Beside the program is a place, too.
cp -r "$prefix/share" "$alone/bin"
[[ $("$alone/bin/chicane" list tracks) == *lakeside* ]] || fail "share/chicane beside the program was not found"
