# Sourced by experiments/demo.sh and tests/run.sh, from the top folder: installs what is missing, then builds. POSIX sh.
#
# Needs Debian 12 or a relative of it; elsewhere it says what is needed and goes on. Nothing is installed, and no
# privileges are asked for, when everything is there. Safe to run again.

BUILD_PACKAGES="g++ cmake make libfmt-dev libglm-dev libboost-graph-dev libcli11-dev libtomlplusplus-dev librandom123-dev libhwy-dev nlohmann-json3-dev libsqlite3-dev libjs-dygraphs catch2 gnuplot-nox"

say() { printf '%s\n' "$*"; }

missing_packages() {
  for package in "$@"; do
    case $(dpkg-query -W -f='${Status}' "$package" 2>/dev/null) in
      *' ok installed') ;;
      *) printf '%s ' "$package" ;;
    esac
  done
}

# install_packages NAME...: those of them that are missing.
install_packages() {
  if ! command -v dpkg-query >/dev/null 2>&1 || ! command -v apt-get >/dev/null 2>&1; then
    say "This is no Debian: please see that these are installed: $*" >&2
    return 0
  fi
  missing=$(missing_packages "$@")
  [ -n "$missing" ] || return 0
  say "Installing with apt-get: $missing"
  as_root=
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
      say "Not root, and there is no sudo. Please run as root: apt-get install $missing" >&2
      return 1
    fi
    as_root=sudo
  fi
  $as_root apt-get update -q || return 1
  # Word splitting is wanted: a list of names.
  # shellcheck disable=SC2086
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $missing
}

processors() { getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1; }

# build_framesim FOLDER TARGET [CMAKE-OPTION...]: configures and builds; with ccache if it is there.
build_framesim() {
  folder=$1
  target=$2
  shift 2
  if command -v ccache >/dev/null 2>&1; then
    set -- -DCMAKE_CXX_COMPILER_LAUNCHER=ccache "$@"
    # Without these ccache keeps nothing that is compiled with a precompiled header.
    CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}
    export CCACHE_SLOPPINESS
  fi
  mkdir -p "$folder" && cmake -S . -B "$folder" "$@" >"$folder/build.log" 2>&1 &&
    cmake --build "$folder" --target "$target" --parallel "$(processors)" >>"$folder/build.log" 2>&1 && return 0
  say "The build in $folder/ failed; the end of $folder/build.log:" >&2
  tail -n 40 "$folder/build.log" >&2
  return 1
}
