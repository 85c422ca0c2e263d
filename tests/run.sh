#!/bin/sh
# Everything that must hold, from a fresh clone. `sh tests/run.sh --quick`: build, tests and golden tables only.
# The last line is "N passed, N failed", counting stages; the exit code is 0 if none failed.
set -u
cd "$(dirname "$0")/.." || exit 1
. experiments/setup.sh

quick=no
case ${1-} in
  '') ;;
  --quick) quick=yes ;;
  *) say "usage: sh tests/run.sh [--quick]" >&2; exit 2 ;;
esac

passed=0
failed=0

# stage NAME COMMAND...: runs it, counts it.
stage() {
  name=$1
  shift
  say "== $name"
  begin=$(date +%s)
  if "$@"; then
    passed=$((passed + 1))
    say "   ok, $(($(date +%s) - begin)) s"
  else
    failed=$((failed + 1))
    say "   FAILED: $name"
  fi
}

# may_skip NAME COMMAND...: a stage whose command exits with 77 where something is missing on this machine. In CI it must run.
may_skip() {
  name=$1
  shift
  code=0
  "$@" >"$out/stage.log" 2>&1 || code=$?
  if [ "$code" -eq 77 ] && [ "${CI-}" != true ]; then
    say "== $name"
    cat "$out/stage.log"
    return
  fi
  stage "$name" show_log "$code"
}

show_log() {
  cat "$out/stage.log"
  [ "$1" -eq 0 ]
}

finish() {
  say "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
  exit
}

# table PROGRAM FILE OPTION...: the comparison as CSV.
table() {
  program=$1
  file=$2
  shift 2
  "$program" compare --quiet --format csv --output "$file" "$@"
}

# Enough of everything to notice a difference, small enough for an unoptimised build.
small() { table "$1" "$2" --scenes street,graphicon-forest,auditorium --frames 40; }

# Errors against 50 digits, in numbers only; the rows have bounds that must hold.
accuracy() { "$1" stability --format csv >"$2"; }

browser() {
  install_packages chromium chromium-driver curl || return 77
  sh tests/report/run.sh build/framesim
}

# One table of all builds; exit code 1 if their numbers differ.
all_builds() {
  build/framesim stability --format html --merge "$out/accuracy-g++.csv" "$out/accuracy-clang.csv" "$out/accuracy-O0.csv" \
    >"$out/accuracy.html"
}

same() { cmp "$1" "$2"; }

# all_tests FOLDER: every test case of FOLDER/framesim_tests, dealt to one process for each processor. Each process
# prints only when all of them are through, so that a failure reads in one piece.
all_tests() {
  shards=$(processors)
  rm -f "$1"/shard-*
  "$1/framesim_tests" --list-test-names-only >"$1/shard-names" || [ -s "$1/shard-names" ] || return 1
  # In a list of names a comma and a bracket mean something else.
  sed 's/[][,\\]/\\&/g' "$1/shard-names" |
    awk -v folder="$1" -v shards="$shards" 'NF { print > (folder "/shard-" NR % shards ".names") }'
  for names in "$1"/shard-*.names; do
    { "$1/framesim_tests" --input-file "$names" >"$names.log" 2>&1; echo $? >"$names.code"; } &
  done
  wait
  failures=0
  for names in "$1"/shard-*.names; do
    sed '/^Filters: /d' "$names.log"
    if [ "$(cat "$names.code")" -ne 0 ] || grep -q 'Invalid Filter' "$names.log"; then failures=1; fi
  done
  return $failures
}

sanitized_tests() {
  ASAN_OPTIONS=detect_leaks=1 UBSAN_OPTIONS=print_stacktrace=1 all_tests build-sanitize
}

packages=$BUILD_PACKAGES
[ "$quick" = yes ] || packages="$packages clang libclang-rt-14-dev libbenchmark-dev coinor-libcbc-dev"
# shellcheck disable=SC2086
stage "packages" install_packages $packages
[ "$failed" -eq 0 ] || finish

stage "build with g++, Release" build_framesim build all -DCMAKE_BUILD_TYPE=Release
[ "$failed" -eq 0 ] || finish
stage "tests" all_tests build
stage "installed: a policy from outside of the tree" sh tests/install/run.sh build
stage "golden tables" build/framesim check tests/golden --quiet
[ "$quick" = no ] || finish

out=results/tests
mkdir -p "$out"
stage "default comparison, 1 thread" table build/framesim "$out/jobs-1.csv" --jobs 1
stage "default comparison, 2 threads" table build/framesim "$out/jobs-2.csv" --jobs 2
stage "1 and 2 threads: same bytes" same "$out/jobs-1.csv" "$out/jobs-2.csv"

may_skip "report in a browser" browser
may_skip "sweep as a job array" sh tests/cluster/slurm.sh build/framesim
stage "accuracy tables" accuracy build/framesim "$out/accuracy-g++.csv"

stage "build with clang++" build_framesim build-clang framesim -DCMAKE_CXX_COMPILER=clang++ -DFRAMESIM_TESTS=OFF
stage "default comparison, clang++" table build-clang/framesim "$out/clang.csv"
stage "g++ and clang++: same bytes" same "$out/jobs-2.csv" "$out/clang.csv"

stage "accuracy tables, clang++" accuracy build-clang/framesim "$out/accuracy-clang.csv"
stage "accuracy with g++ and clang++: same bytes" same "$out/accuracy-g++.csv" "$out/accuracy-clang.csv"

stage "fuzzing, 4 s a target" sh tests/fuzz/run.sh 4
stage "build with sanitizers, -O0" build_framesim build-sanitize all -DCMAKE_BUILD_TYPE=Debug -DFRAMESIM_SANITIZE=ON \
  -DFRAMESIM_BENCHMARKS=OFF
stage "tests with sanitizers" sanitized_tests
stage "accuracy tables, -O0 with sanitizers" accuracy build-sanitize/framesim "$out/accuracy-O0.csv"
stage "accuracy with -O0 and -O2: same bytes" same "$out/accuracy-g++.csv" "$out/accuracy-O0.csv"
stage "accuracy of all builds in one table" all_builds
stage "small comparison, -O2" small build/framesim "$out/small-O2.csv"
stage "small comparison, -O0 with sanitizers" small build-sanitize/framesim "$out/small-O0.csv"
stage "-O0 and -O2: same bytes" same "$out/small-O2.csv" "$out/small-O0.csv"
finish
