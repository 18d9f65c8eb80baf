# shellcheck shell=bash
# Set-up that ./run and ./test share; sourced by both, with the repository's root as the current folder.
# Every step looks first and does only what is missing, so a second call needs neither network nor root.

# One list that has the same names on Debian 12 and 13. The first three lines build; then what runs; then the game.
readonly kPackages="git build-essential cmake ninja-build pkg-config ca-certificates
  libvulkan-dev libvulkan-volk-dev glslang-tools spirv-tools libsdl2-dev libjpeg-dev libstb-dev libglm-dev
  libminizip-dev zlib1g-dev libzstd-dev libopenexr-dev nlohmann-json3-dev libcli11-dev libembree-dev libgtest-dev
  libbenchmark-dev
  vulkan-validationlayers vulkan-tools xvfb xauth debian-archive-keyring
  ioquake3 openarena openarena-data openarena-088-data openarena-oacmp1"

fail() {
  echo "q3rt set-up: $*" >&2
  exit 1
}

# step TEXT: heading of a step, with the time since the start (Q3RT_QUIET keeps a second run silent).
step() { printf -- '-- [%3d s] %s\n' "$SECONDS" "$1"; }

releaseOf() { (. /etc/os-release 2>/dev/null && echo "${ID:-unknown} ${VERSION_ID:-}") || echo unknown; }

# missingPackages NAME...: those that dpkg doesn't have installed.
missingPackages() {
  local installed
  installed=" $(dpkg-query -W -f '${Package}:${db:Status-Status} ' "$@" 2>/dev/null || true) "
  local name
  for name in "$@"; do
    case "$installed" in *" $name:installed "*) ;; *) printf '%s ' "$name" ;; esac
  done
}

# setUpPackages [fuzz]: installs what is missing of the list (and of what the fuzz targets need).
setUpPackages() {
  local release packages missing asRoot=""
  release="$(releaseOf)"
  packages="$kPackages"
  case "$release" in
  "debian 12") [ "${1:-}" = fuzz ] && packages+=" clang libclang-rt-14-dev" ;;
  "debian 13") packages+=" mesa-vulkan-drivers" && [ "${1:-}" = fuzz ] && packages+=" clang libclang-rt-19-dev" ;;
  *)
    [ -n "${Q3RT_SKIP_PACKAGES:-}" ] && return 0
    fail "packages can be installed on Debian 12 and 13 only, this is '$release':" \
      "install the list in scripts/setup.sh by hand and set Q3RT_SKIP_PACKAGES=1"
    ;;
  esac
  [ -n "${Q3RT_SKIP_PACKAGES:-}" ] && return 0
  [ "$(uname -m)" = x86_64 ] || fail "only x86_64 is supported, this machine is $(uname -m)"
  # shellcheck disable=SC2086 # a list of words
  missing="$(missingPackages $packages)"
  [ -z "$missing" ] && return 0

  step "installing packages: $missing"
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null || fail "packages are missing and need root; as root, run: apt-get install $missing"
    asRoot="sudo"
    sudo -v || fail "sudo was refused; as root, run: apt-get install $missing"
  fi
  local apt="$asRoot env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0"
  $apt update || fail "the package lists could not be fetched (see above): check the network, then run this again"
  # shellcheck disable=SC2086
  $apt install --no-install-recommends $missing ||
    fail "packages could not be installed (see above): check the network and the free disk space (1.6 GB)," \
      "then run this again"
}

# setUpDriver [VARIABLE]: has the ray-tracing software driver fetched, where q3rt and the modules look for it by
# themselves; exports VARIABLE = its ICD file.
setUpDriver() {
  local icd
  icd="$(scripts/lavapipe.sh)" || exit 1
  [ $# = 0 ] || export "$1=$icd"
}

# configureProgram FOLDER [CMAKE-ARGUMENT...]: once for each folder; the build itself notices changed lists later.
configureProgram() {
  local folder="$1" launcher=()
  shift
  [ -e "$folder/build.ninja" ] && return 0
  step "configuring $folder"
  mkdir -p "$folder" 2>/dev/null || fail "cannot write $PWD/$folder: make the folder writable or clone elsewhere"
  command -v ccache >/dev/null &&
    launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release "${launcher[@]}" "$@" >"$folder/configure.log" 2>&1 || {
    tail -n 25 "$folder/configure.log" >&2
    fail "configuring failed, see $folder/configure.log"
  }
}

# compileProgram FOLDER [TARGET...]: builds what changed (everything without a target), with progress and time left.
compileProgram() {
  local folder="$1" jobs memoryJobs
  shift
  # One compiler takes up to 1.2 GB: no more of them than fit into memory.
  jobs="$(nproc)"
  memoryJobs="$(awk '/^MemAvailable/ { print int($2 / 1200000) }' /proc/meminfo)"
  [ "$memoryJobs" -lt "$jobs" ] && jobs=$((memoryJobs > 1 ? memoryJobs : 1))
  step "building $folder with $jobs jobs"
  NINJA_STATUS='[%f/%t, %es] ' cmake --build "$folder" --parallel "$jobs" ${1:+--target "$@"} ||
    fail "the build failed, see above"
}
