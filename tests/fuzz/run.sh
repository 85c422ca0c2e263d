#!/bin/sh
# Fuzzes the readers of input, over the sanitizers: sh tests/fuzz/run.sh [SECONDS] [TARGET...]
#
# Builds tests/fuzz/*.cpp with clang++ in $FRAMESIM_FUZZ_BUILD (build-fuzz), runs each TARGET (all) for SECONDS (20), as many
# at a time as there are processors, and prints how many inputs each executed. What is found is kept in
# $FRAMESIM_FUZZ_BUILD/findings/TARGET/ and ends the script with 1. Inputs that reach new code are kept in
# $FRAMESIM_FUZZ_BUILD/grown/TARGET/, so that a later run goes on from there; tests/fuzz/corpus/ is only read.
#
# An hour on two processors:   nice sh tests/fuzz/run.sh 655    (eleven targets, two at a time)
# One finding again:           build-fuzz/fuzz_TARGET build-fuzz/findings/TARGET/crash-...
set -eu
cd "$(dirname "$0")/../.."
build=${FRAMESIM_FUZZ_BUILD:-build-fuzz}
# Readers of files get them from memory: 18 times as many executions as from a disk.
if [ -z "${TMPDIR-}" ] && [ -w /dev/shm ]; then export TMPDIR=/dev/shm; fi

fuzz_one() { # SECONDS TARGET
  seconds=$1 target=$2 status=0 length=8192
  [ "$target" = words ] && length=256 # a long list of words takes long, and says no more
  mkdir -p "$build/grown/$target" "$build/findings/$target"
  if [ -f "tests/fuzz/$target.dict" ]; then set -- "-dict=tests/fuzz/$target.dict"; else set --; fi
  "$build/fuzz_$target" -max_total_time="$seconds" -max_len="$length" -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
    -verbosity=0 -artifact_prefix="$build/findings/$target/" "$@" \
    "$build/grown/$target" "tests/fuzz/corpus/$target" >"$build/$target.log" 2>&1 || status=$?
  executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/$target.log")
  if [ "$status" -eq 72 ]; then # libFuzzer's code for an interrupt
    echo "$target: $executed executions until interrupted, nothing found"
  elif [ "$status" -ne 0 ]; then
    echo "$target: a finding after ${executed:-?} executions"
    tail -n 40 "$build/$target.log" >&2
    return 1
  else
    echo "$target: $executed executions in $seconds s, nothing found"
  fi
}

if [ "${1-}" = --one ]; then
  fuzz_one "$2" "$3"
  exit
fi

seconds=20
case ${1-} in
  '' | *[!0-9]*) ;;
  *) seconds=$1 && shift ;;
esac
if [ $# -eq 0 ]; then
  for source in tests/fuzz/*.cpp; do set -- "$@" "$(basename "$source" .cpp)"; done
fi

options=
command -v ninja >/dev/null && options="-G Ninja"
command -v ccache >/dev/null && options="$options -DCMAKE_CXX_COMPILER_LAUNCHER=ccache"
# shellcheck disable=SC2086
cmake -S . -B "$build" $options -DCMAKE_CXX_COMPILER="${FRAMESIM_CLANG:-clang++}" -DCMAKE_BUILD_TYPE=Release \
  -DFRAMESIM_FUZZ=ON -DFRAMESIM_TESTS=OFF -DFRAMESIM_BENCHMARKS=OFF >/dev/null
cmake --build "$build" --target fuzz --parallel "$(nproc)" >&2
printf '%s\n' "$@" | xargs -n 1 -P "$(nproc)" sh tests/fuzz/run.sh --one "$seconds" || exit 1
