#!/bin/sh
# Breaks guarded formulas one at a time and looks whether a named test notices: sh tests/hard_cases/mutations.sh [BUILD]
#
# BUILD (build) is a Ninja build folder whose framesim_tests is up to date. Nothing in the tree or in BUILD is touched: a
# changed copy of one source is compiled and linked in front of the libraries. Prints a table; exit code 1 if a mutation is
# missed, or could not be made. Not part of CI: ten compilations and links, some two minutes.
#
# A line of the list: FILE; a sed command that breaks it; the name of the test that must fail. A mutation that changes
# nothing, or does not compile, is an error here, so that the list keeps up with the code.
set -eu
cd "$(dirname "$0")/../.."
root=$PWD
build=${1-build}
command -v ninja >/dev/null || { echo "mutations.sh needs ninja" >&2; exit 2; }
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT INT TERM

list() {
  cat <<'LIST'
sim/statistics.cpp; s/squares_ += from_old_mean \* (x - running_mean_)/squares_ += from_old_mean * from_old_mean/; Welford keeps the deviation of steady frame times, the mean of squares loses it
sim/closed_form.cpp; s/longer = std::max(t_l, t_r)/longer = t_l/; s = 1 is the sum, s = 0 the maximum, to the last picosecond of long durations
sim/clock.cpp; s/FRAMESIM_CHECK(!overflow,/FRAMESIM_CHECK(true || !overflow,/; a clock that would pass its end is refused with the simulated time
sim/estimators/least_squares.cpp; s/r\[k\]\[k\] < kDependent/r[k][k] <= 0/; least squares: a dependent column is left out, the first one carries the cost
sim/estimators/least_squares.cpp; s/x\[worst\] >= 0/x[worst] >= -1e300/; least squares: a negative coefficient becomes 0 and the other is fitted again
sim/planners/inverse.cpp; s/if (logic_s >= target_s) return 0;//; inverse planner: closed forms by hand
policies/knapsack/hull_greedy.cpp; s/single.gain > gain_/single.gain > 1e300/; funkhouser: repaired reaches half of the optimum and its bound holds, on 2000 random cases
policies/robin_hood.cpp; s/price_s.add(rest_s \/ suffix_\[k + 1\])/price_s.add(rest_s \/ suffix_[k])/; robin-hood: three instances by hand, the remainder passed on, simple to complex
policies/pid.cpp; s/if (!clamped_ || locked)/if (!clamped_)/; control: recovery after ten missed frames
policies/shares/box_shares.cpp; s/if (share_s > box.high_s) over += share_s - box.high_s;//; box shares: a saturated box is removed and the rest solved again
policies/gradient/curve_ascent.cpp; s/std::max(v.x, kFirstResolution)/v.x/; mixed-gradient: the first gradient step shares in proportion to benefit
scenes/generators/place.cpp; s/size + more > most)/size + more > most + 1)/; the limit counts every way of making instances, and is the caller's to set
scenes/scene_file.cpp; s/|| !is_below(whole, folder.path)//; a symbolic link may not lead out of the scene's folder
LIST
}

fails() { # BINARY TEST: 0 if the test was found and failed. Catch2 splits names at commas
  status=0
  "$1" "$(printf %s "$2" | sed 's/,/\\,/g')" >"$scratch/out" 2>&1 || status=$?
  grep -q 'No test cases matched' "$scratch/out" && { echo "no test '$2'" >&2; exit 2; }
  [ "$status" -ne 0 ]
}

link=$(ninja -C "$build" -t commands framesim_tests | tail -n 1)
list >"$scratch/list"
missed=0
number=0
while IFS= read -r line; do
  number=$((number + 1))
  file=${line%%; *} rest=${line#*; }
  change=${rest%; *} test=${rest##*; }
  verdict=caught
  sed "$change" "$file" >"$scratch/mutant.cpp"
  compile=$(ninja -C "$build" -t commands framesim_tests | grep -- "-c [^ ]*/$file\$" | head -n 1 |
    sed "s|-o [^ ]*|-o $scratch/mutant.o|; s|-MF [^ ]*|-MF $scratch/mutant.d|; s|-c [^ ]*\$|-c $scratch/mutant.cpp|")
  fails "$build/framesim_tests" "$test" && verdict='fails without it'
  if cmp -s "$file" "$scratch/mutant.cpp"; then
    verdict='changes nothing'
  elif ! (cd "$build" && sh -c "$compile") >"$scratch/log" 2>&1; then
    verdict='does not compile' && cat "$scratch/log" >&2
  elif ! (cd "$build" && sh -c "$(printf %s "$link" | sed "s|-o framesim_tests |-o $scratch/mutant $scratch/mutant.o |")") \
    >"$scratch/log" 2>&1; then
    verdict='does not link' && cat "$scratch/log" >&2
  elif ! fails "$scratch/mutant" "$test"; then
    verdict=MISSED
  fi
  [ "$verdict" = caught ] || missed=$((missed + 1))
  printf '%2d  %-10s %-38s %s\n' "$number" "$verdict" "$file" "$test"
done <"$scratch/list"
cd "$root"
echo "$number mutations, $missed not caught"
[ "$missed" -eq 0 ]
