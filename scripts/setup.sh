# Sourced by the other scripts: exits at the first error; functions that install missing packages and build the release preset. Sets
# root, FROND_BUILD and FROND.
set -euo pipefail

# -h and --help print the comment at the head of the sourcing script and exit.
for argument in "$@"; do
  case "$argument" in
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "${BASH_SOURCE[1]}"; exit 0 ;;
  esac
done

# no_arguments "$@": exits with an error if there are arguments.
no_arguments() {
  [ $# -eq 0 ] && return
  echo "usage: scripts/$(basename "${BASH_SOURCE[1]}")" >&2
  exit 1
}

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
FROND_BUILD="$root/build/release"
FROND="$FROND_BUILD/frond"

configure_options=()  # options of CMake in addition to the preset's

# Debian packages that the build needs.
build_packages=(
  g++ cmake ninja-build pkg-config ccache
  libembree-dev libopenimageio-dev libwebp-dev libopenexr-dev libopencolorio-dev libfmt-dev libcli11-dev nlohmann-json3-dev libeigen3-dev
  libzstd-dev zlib1g-dev libboost-dev libgmock-dev libbenchmark-dev libnetcdf-dev libmeshoptimizer-dev
  librsvg2-dev libnanovdb-dev
)

install_missing() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  if ! command -v apt-get >/dev/null; then
    echo "These packages are missing and there is no apt-get to install them: ${missing[*]}" >&2
    exit 1
  fi
  echo "Installing ${missing[*]}"
  as_root apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# seconds COMMAND...: runs it, and sets took to the seconds that it took.
seconds() {
  local start=$SECONDS
  "$@"
  took=$((SECONDS - start))
}

as_root() { if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi; }

# quietly COMMAND...: runs it in the root; prints its output only if it fails.
quietly() {
  local log
  log=$(mktemp)
  if ! (cd "$root" && "$@") >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    rm -f "$log"
    exit 1
  fi
  rm -f "$log"
}

# with_progress COMMAND...: like quietly, for a build by Ninja; prints its progress, on a terminal in one line, elsewhere every 30 s.
with_progress() {
  local log code=0 step all shown=$SECONDS
  log=$(mktemp)
  (cd "$root" && "$@") 2>&1 | tee "$log" | sed -un 's|^\[\([0-9]*\)/\([0-9]*\)\].*|\1 \2|p' |
    while read -r step all; do
      [ "$all" = 0 ] && continue
      if [ -t 1 ]; then
        printf '\r  step %d of %d, %d %%\033[K' "$step" "$all" $((100 * step / all))
      elif ((SECONDS - shown >= 30)); then
        printf '  step %d of %d, %d %%\n' "$step" "$all" $((100 * step / all))
        shown=$SECONDS
      fi
    done || code=$?
  if [ -t 1 ]; then printf '\r\033[K'; fi
  [ "$code" = 0 ] || { tail -n 60 "$log" >&2; rm -f "$log"; exit "$code"; }
  rm -f "$log"
}

# python_venv NAME PACKAGE...: makes an environment of Debian's Python with packages of PyPI in build/NAME; fails if they cannot be
# installed.
python_venv() {
  local venv="$root/build/$1"
  shift
  install_missing python3 python3-venv
  [ -x "$venv/bin/python" ] || /usr/bin/python3 -m venv "$venv" || return 1
  local wanted="$*"
  [ "$(cat "$venv/wanted" 2>/dev/null)" = "$wanted" ] && return
  "$venv/bin/pip" install -q --disable-pip-version-check "$@" >&2 || return 1
  echo "$wanted" >"$venv/wanted"
}

# Adds the Python module to later builds, and makes the environment of tests and measurements; fails if PyPI's packages cannot be
# installed. Mitsuba's LLVM variants load libllvm 19.
with_python_module() {
  python_venv python-venv nanobind==3.1.0 nanobind-backend==1.0.0 numpy pandas scipy==1.17.1 matplotlib==3.11.2 xarray pytest nbclient ipykernel mitsuba==3.9.1 pvlib==0.16.1 reuse==6.2.0 ||
    return 1
  if apt-cache show libllvm19 >/dev/null 2>&1; then install_missing libllvm19; fi
  configure_options+=(-DFROND_PYTHON=ON "-DPython_EXECUTABLE=$root/build/python-venv/bin/python")
}

# Environments of the leaf benchmark; Eradiate brings a Mitsuba of its own.
benchmark_packages=(mitsuba==3.9.1 bpy==5.0.1 pyradiance==1.3.1 less3d==3.0.1 flip-evaluator==1.7 nanobind-backend==1.0.0 numpy==1.26.4 pandas
  scipy==1.17.1 matplotlib==3.11.2)
eradiate_packages=("eradiate[kernel]==1.2.0" nanobind-backend==1.0.0 pandas matplotlib==3.11.2)

# Without these values ccache does not cache sources that include a precompiled header.
case ",${CCACHE_SLOPPINESS:-}," in
  *,pch_defines,time_macros,*) ;; # set by a script that calls this one: another value would compile everything again
  *) export CCACHE_SLOPPINESS="${CCACHE_SLOPPINESS:+$CCACHE_SLOPPINESS,}pch_defines,time_macros" ;;
esac

configure() {
  local options=("${configure_options[@]}")
  command -v ccache >/dev/null && options+=("-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_SLOPPINESS=$CCACHE_SLOPPINESS;ccache")
  quietly cmake --preset "$1" "${options[@]}"
}

# build_preset PRESET OPTION...: the options are those of cmake --build.
build_preset() {
  configure "$1"
  with_progress cmake --build --preset "$@"
}

# install_compiler PRESET: installs its compiler, if that is not g++.
install_compiler() { if [ "$1" = clang ]; then install_missing clang-19; fi; }

# build TARGET...: builds targets of the preset release.
build() {
  echo "Building $*"
  build_preset release --target "$@"
}
