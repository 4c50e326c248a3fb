# shellcheck shell=bash
# Sourced by ./demo and ./check: what both need before they start.
#   install_missing   installs the Debian packages that are not there; without network when all are
#   build [TARGET]    builds in build/ (Release): everything, or one target, for which a new folder is
#                     configured without tests, benchmarks, Python module and MPI
# The caller sets $root, the repository. MORTIER_JOBS sets the number of compilers that run at once.
: "${root:?}"

# What the program needs, and the other code.
packages=(
  g++ cmake ninja-build
  libeigen3-dev libsuitesparse-dev libopenblas-dev  # linear algebra
  libtomlplusplus-dev libcli11-dev nlohmann-json3-dev  # scenes, command line, summaries
  libgmsh-dev                                       # meshes other than Medit's
  freefem++                                         # the other code
  python3 python3-numpy python3-matplotlib python3-meshio  # comparison and pictures
)

say() { printf '\n== %s\n' "$*"; }
die() { printf 'error: %s\n' "$*" >&2; exit 1; }

# The output of a command is shown only when it fails.
quietly() {
  local log status
  log=$(mktemp) || die "no temporary file"
  "$@" >"$log" 2>&1
  status=$?
  [ $status -eq 0 ] || tail -n 30 "$log" >&2
  rm -f "$log"
  return $status
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || echo "$package"
  done
}

install_missing() {
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    say "This is no Debian: the packages below, or their likes, must be there already"
    echo "${packages[*]}"
    return
  fi
  local missing as_root=()
  mapfile -t missing < <(missing_packages)
  [ "${#missing[@]}" -eq 0 ] && return
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "only root can install these packages, and there is no sudo here:
  apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  say "Installing ${#missing[@]} Debian packages and what they need; this takes a minute or two"
  echo "${missing[*]}"
  quietly "${as_root[@]}" apt-get update -q || die "apt-get update failed; is there a network?"
  quietly "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${missing[@]}" ||
    die "apt-get could not install: ${missing[*]}"
  mapfile -t missing < <(missing_packages)
  [ "${#missing[@]}" -eq 0 ] || die "still missing: ${missing[*]}"
}

# As many compilers as processors, but each with 2 GiB.
jobs_at_once() {
  local processors memory
  processors=$(nproc)
  memory=$(awk '/^MemAvailable/ { print int($2 / 2097152) }' /proc/meminfo 2>/dev/null)
  [ "${memory:-$processors}" -lt "$processors" ] && processors=$memory
  [ "$processors" -ge 1 ] || processors=1
  echo "${MORTIER_JOBS:-$processors}"
}

build() {
  # Sources are compiled a dozen at a time: that halves the time of a first build.
  local options=(-DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12)
  local folder="$root/build" all=(TESTS BENCH PYTHON MUMPS)
  case $root in
    *[\"\;\$\\]*) die "CMake cannot build in $root: expected a path without \" ; \$ and \\" ;;
  esac
  # A build folder that came from elsewhere knows the wrong paths.
  local cache=$folder/CMakeCache.txt
  if [ -f "$cache" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache"; then
    rm -rf "$folder"
  fi
  if [ $# -eq 0 ]; then
    options+=("${all[@]/#/-UMORTIER_}")  # each as what is installed now allows
  elif [ ! -f "$cache" ]; then
    local name
    for name in "${all[@]}"; do options+=("-DMORTIER_$name=OFF"); done
  fi
  [ -f "$cache" ] || options+=(-G Ninja)
  if [ "$(uname -m)" = x86_64 ] && ! { grep -qw avx2 /proc/cpuinfo && grep -qw fma /proc/cpuinfo; }; then
    options+=(-DMORTIER_ARCH=x86-64)
  fi
  say "Building in build/ ($(jobs_at_once) at once)"
  quietly cmake -S "$root" -B "$folder" "${options[@]}" || die "cmake could not configure the build"
  cmake --build "$folder" --parallel "$(jobs_at_once)" ${1:+--target "$1"} || die "the build failed"
}
