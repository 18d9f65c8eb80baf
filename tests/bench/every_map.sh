#!/bin/bash
# tests/bench/every_map.sh [MAP...]: every map of the data, and stretches of every demo, by renderer_rt under core and
# synchronisation validation. A line for each one that says anything; exit 1 if one does. PICTURES=DIR keeps the maps'
# pictures and puts them on one sheet, DIR/every_map.jpg (needs ImageMagick). SIZE, FRAMES and DEMOS= (none) shorten it;
# names of maps alone draw these maps and no demo.
set -uo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
program="${Q3RT:-build/q3rt}" size="${SIZE:-160x120}" frames="${FRAMES:-4}"
demos="${DEMOS-demo088-test1 flyby_compromise flyby_hydronex flyby_oaspirit flyby_oa_dm3 flyby_suspended \
stress_bases3 stress_sago stress_q3dm6ishv2}"
export Q3RT_VALIDATION=1
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/maps"
drawn=0 faults=0

# What validation says goes to stderr, as all messages do.
check() { # NAME COMMAND...
  local name="$1"
  shift
  if ! "$@" >"$work/out" 2>"$work/err" || grep -q 'Vulkan validation' "$work/out" "$work/err"; then
    faults=$((faults + 1))
    echo "$name: $(grep -h -m 1 -E 'Vulkan validation|q3rt:' "$work/out" "$work/err" | head -1)"
  fi
  drawn=$((drawn + 1))
}

if [ $# -eq 0 ]; then
  mapfile -t maps < <("$program" info --all --json | grep -o '"map": *"[^"]*"' | cut -d'"' -f4 |
    sed 's|^maps/||; s|\.bsp$||')
else
  maps=("$@")
  demos=""
fi
for map in "${maps[@]}"; do
  check "$map" "$program" view --map "$map" --at "spawn:${SPAWN:-0}" --renderer rt --size "$size" --frames "$frames" \
    --verbose --out "$work/maps/$map.png"
done
for demo in $demos; do
  # The start, and a stretch from the middle of the shortest.
  for first in 30 400; do
    check "$demo" "$program" record --demo "$demo" --first "$first" --count 12 --out "$work/demo.q3t"
    check "$demo from $first" "$program" replay "$work/demo.q3t" --renderer rt --size "$size" --verbose
  done
done
if [ -n "${PICTURES:-}" ]; then
  mkdir -p "$PICTURES"
  montage -label '%t' "$work"/maps/*.png -tile 9x -geometry "${size}+2+2" -background '#202020' -fill white \
    -pointsize 11 -quality 82 "$PICTURES/every_map.jpg"
fi
echo "${#maps[@]} maps, $drawn runs, $faults with messages"
[ "$faults" -eq 0 ]
