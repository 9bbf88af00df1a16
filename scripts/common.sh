# What setup, run and test share; sourced, not run. Puts the caller into the project's root.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
logs=$PWD/build/logs
mkdir -p "$logs"

export LC_ALL=C.UTF-8                                                    # a bare machine has no other locale
export HOME=${HOME:-$(getent passwd "$(id -u)" | cut -d: -f6)}           # emcc, ccache and npm keep caches there
[ ! -d /usr/share/nodejs ] || export NODE_PATH=${NODE_PATH:-/usr/share/nodejs} # Debian's emcc looks for acorn there

say() { echo "$program: $*"; }

fail() {
  echo "$program: $*" >&2
  exit 1
}

# Prints the comment at the top of a script, and ends.
show_help() {
  sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$1"
  exit 0
}

# step NAME COMMAND...: runs it with its output in build/logs/NAME.log; says how long it took, or shows the end of
# the log and stops.
step() {
  local name=$1 start=$SECONDS
  shift
  if ! "$@" >"$logs/$name.log" 2>&1; then
    tail -n 40 "$logs/$name.log" >&2
    fail "$name: failed; the whole output is in build/logs/$name.log"
  fi
  say "$name: done in $((SECONDS - start)) s"
}

# build PRESET [TARGET...]: configures and builds, all targets by default; ninja's own lines show the progress.
build() {
  local preset=$1 start=$SECONDS
  shift
  say "$preset: building"
  step "$preset-configure" cmake --preset "$preset"
  cmake --build --preset "$preset" ${1:+--target "$@"} || fail "$preset: does not build; see the lines above"
  say "$preset: built in $((SECONDS - start)) s"
}

# make_assets [--first | --tests]
make_assets() { /usr/bin/python3 scripts/make_assets.py "$@" || fail "assets: cannot be made; see the lines above"; }

# The page with its modules, gallery and documentation, in build/web/site.
# bundle_page [--first]: what is needed to open it, with what else is there already
bundle_page() {
  step page node scripts/build_web.mjs --wasm build/web --out build/web/site "${@:---program=build/native/lucent}"
}
