#!/bin/bash
# tests/bench/every_map.sh [MAP...]: every map of the data, and stretches of every demo, by renderer_rt under core and
# synchronisation validation. A line for each one that says anything; exit 1 if one does. PICTURES=DIR puts the
# maps' pictures on one sheet, DIR/every_map.jpg (needs ImageMagick). SIZE, FRAMES and DEMOS= (none) shorten it;
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

# The first player start; where a map has none for single players, another start of its own.
eye_of() { # MAP
  case "$1" in
  am_galmevish2) echo "-640 320 50 0 -45" ;;
  am_lavaarena) echo "-1632 -1440 90 0 45" ;;
  am_lavactf) echo "784 480 -37 0 -90" ;;
  am_lavactfxl) echo "456 1296 90 0 0" ;;
  am_spacecont) echo "416 272 -310 0 -90" ;;
  am_thornish) echo "1280 -720 -574 0 -180" ;;
  am_underworks) echo "1856 1408 -654 0 180" ;;
  am_underworks2) echo "-64 1344 -182 0 -90" ;;
  blitzkrieg3) echo "-720 -464 106 0 45" ;;
  delta) echo "552 392 1058 0 0" ;;
  hydronex2) echo "-192 -5056 -14 0 -90" ;;
  oa_bases3p3ta) echo "-496 -1728 -134 0 90" ;;
  oa_bases3plus3) echo "-560 -1728 -134 0 90" ;;
  oa_bases5) echo "-672 -1440 -86 0 270" ;;
  oa_ctf4ish) echo "2068 -558 1571 0 180" ;;
  oa_reptctf11) echo "1104 -784 26 0 0" ;;
  oa_thor) echo "960 -384 2 0 90" ;;
  oacmpdm6) echo "-778.5 -792.5 666.5 0 90" ;;
  oacmpdm8) echo "5.25 419 118 0 0" ;;
  *) echo spawn:0 ;;
  esac
}

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
  check "$map" "$program" view --map "$map" --at "$(eye_of "$map")" --renderer rt --size "$size" --frames "$frames" \
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
