#!/bin/sh
# sh tests/install/run.sh BUILD: installs what BUILD/ has into a folder that is gone afterwards, builds the example beside
# this file against it, and holds its output against framesim's own.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' INT TERM

fail() { echo "install: $*" >&2; exit 1; }

# refused EXPECTED-CODE TEXT COMMAND...: ends with that code and says that on stderr, nothing on stdout.
refused() {
  code=$1 text=$2
  shift 2
  found=0
  "$@" >"$folder/out" 2>"$folder/err" || found=$?
  [ "$found" -eq "$code" ] || fail "$* ended with $found, not $code: $(cat "$folder/err")"
  [ ! -s "$folder/out" ] || fail "$* printed a result all the same"
  grep -q "$text" "$folder/err" || fail "$* did not say '$text' but: $(cat "$folder/err")"
}

cmake --install "$build" --prefix "$folder/usr" >"$folder/log" || { cat "$folder/log" >&2; exit 1; }
cmake -S "$here" -B "$folder/example" -DCMAKE_PREFIX_PATH="$folder/usr" >"$folder/log" 2>&1 &&
  cmake --build "$folder/example" >>"$folder/log" 2>&1 || { cat "$folder/log" >&2; exit 1; }
framesim=$folder/usr/bin/framesim
mine=$folder/example/my_framesim
plugin=$folder/example/nearest.so

# The libraries alone: the frame times that the program gives.
"$folder/example/ten_frames" >"$folder/times"
"$framesim" run street --plugin "$plugin" --policy nearest --target 25ms --estimator oracle --no-effect all --frames 10 --quiet \
  --frames-out "$folder/frames.csv" >"$folder/out"
awk -F , 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == "frame_time_ps") at = i; next } { print $at }' "$folder/frames.csv" |
  cmp - "$folder/times"

# Stock rows are the same in all three programs; the policy of one's own is the same linked in and as a plug-in.
compare="compare --scenes street,auditorium --frames 40 --quiet --format csv"
"$framesim" $compare --policies static,funkhouser >"$folder/stock.csv"
"$mine" $compare --policies static,funkhouser,nearest:objects=2 >"$folder/mine.csv"
"$framesim" $compare --plugin "$plugin" --policies static,funkhouser,nearest:objects=2 >"$folder/plugin.csv"
cmp "$folder/mine.csv" "$folder/plugin.csv"
grep -v nearest "$folder/mine.csv" | cmp - "$folder/stock.csv"
[ "$(grep -c nearest "$folder/mine.csv")" -eq 2 ] || fail "nearest did not run on both scenes"
"$framesim" list policies --plugin "$plugin" | grep -q 'objects=3' || fail "list does not show the plug-in's parameter"

# A relative name means the file here; what does not fit is refused before it runs.
cd "$folder/example"
"$framesim" list policies --plugin nearest.so | grep -q nearest || fail "a name without a slash was not found"
refused 3 'interface 2' "$framesim" list --plugin bad_interface.so
refused 3 'another layout' "$framesim" list --plugin bad_layout.so
refused 3 'taken' "$framesim" list --plugin bad_name.so
refused 3 'no shared library' "$framesim" list --plugin CMakeCache.txt
refused 3 'no such file' "$framesim" list --plugin none.so
refused 3 'no symbol' "$framesim" list --plugin "$(ldd "$framesim" | sed -n 's/.*=> \(.*libfmt[^ ]*\).*/\1/p')"
refused 2 "unknown policy 'nearest'" "$framesim" run street --policy nearest

# The manual page and the completions are those of the program.
"$framesim" man | cmp - "$folder/usr/share/man/man1/framesim.1"
"$framesim" completion bash | cmp - "$folder/usr/share/bash-completion/completions/framesim"
echo "install: the example outside of the tree gives framesim's own rows, and its policy runs linked in and as a plug-in"
