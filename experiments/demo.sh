#!/bin/sh
# From a fresh clone to a table and pictures: which policies hold the target frame time, and which do not.
set -eu
cd "$(dirname "$0")/.."
. experiments/setup.sh

# shellcheck disable=SC2086
install_packages $BUILD_PACKAGES
say "Building in build/ (log: build/build.log) ..."
build_framesim build framesim

mkdir -p results
rm -f results/*.svg
say "Comparing all policies on all built-in scenes ..."
build/framesim compare --output results/table.txt --plot results --quiet

say "Table: results/table.txt. Pictures (frame time over frames; beside each, *-levels.svg: levels over frames):"
for picture in results/*-frame-time.svg; do say "  $picture"; done
say ""
cat results/table.txt
say "How to read it: 'yes' holds the target; 'NO 3.00x' means that one frame in twenty takes at least 3 times the target."
