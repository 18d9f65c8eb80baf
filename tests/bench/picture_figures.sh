#!/bin/bash
# How near the denoised picture comes to the truth.
#
#   picture_figures.sh static MAP...       8 cameras a map, clock frozen, the 32nd frame; beside it all lights plain
#   picture_figures.sh motion RECORDING    240 consecutive frames; beside it without gradient, without denoiser, plain
#   picture_figures.sh finite RECORDING... what rt_checkFinite counts in all their frames
#   picture_figures.sh summary             what has been measured so far, of all files in $OUT
#
# 320x240, rt_antialiasing 1 on both sides. A killed run goes on where it stopped: references are kept in
# $XDG_CACHE_HOME/q3rt, results in $OUT (default: picture_figures). Q3RT names the program, GAME_ARGS the game data
# (such as "--basepath FOLDER"). Smaller trials: CAMERAS, REFERENCE_FRAMES, FIRST, COUNT, SIZE.
set -euo pipefail
program="${Q3RT:-build/q3rt}"
out="${OUT:-picture_figures}"
read -r -a game <<<"${GAME_ARGS:-}"
common=(--size "${SIZE:-320x240}" --count 1 --pictures 1 --set rt_antialiasing=1 "${game[@]}")
mkdir -p "$out"

measure() { # FILE ARGUMENT...: a sweep, its table to the log
  local file="$out/$1.jsonl"
  shift
  "$program" trade "$@" "${common[@]}" --out "$file" >>"$out/tables.txt"
}

# Eight cameras: the first player starts; where a map has fewer of them, its team starts, 26 units up.
list_cameras() { # MAP
  case "$1" in
  oa_dm1) printf '%s\n' spawn:0 spawn:1 spawn:2 spawn:3 spawn:4 spawn:5 spawn:6 "324 1156 50 0 180" ;;
  hydronex)
    printf '%s\n' spawn:0 "704 -2976 98 0 90" "-280 -2680 98 0 -89" "-576 -4832 -6 0 90" "704 2920 98 0 -90" \
      "288 -2688 98 0 -90" "576 4768 -6 0 -90" "-288 2624 98 0 90"
    ;;
  *) printf 'spawn:%d\n' {0..7} ;;
  esac
}

measure_still() { # MAP
  local view=(--map "$1" --reference-frames "${REFERENCE_FRAMES:-4096}") camera
  while IFS= read -r camera; do
    view+=(--at "$camera")
  done < <(list_cameras "$1" | head -"${CAMERAS:-8}")
  measure "static_$1" "${view[@]}" --warmup 31 --axis rt_numRandomDL=1 --axis rt_denoiser=1,2 --axis rt_taa=1
  measure "static_$1" "${view[@]}" --warmup 0 --axis rt_numRandomDL=0,1 --axis rt_denoiser=0 --axis rt_taa=0 \
    --axis frames=1,32
}

measure_motion() { # RECORDING
  local first="${FIRST:-660}"
  local frames
  frames="$(seq -s, "$first" $((first + ${COUNT:-240} - 1)))"
  local view=("$1" --frames "$frames" --warmup 60 --reference-frames "${REFERENCE_FRAMES:-1024}")
  measure motion "${view[@]}" --axis rt_denoiser=1,2,0 --axis rt_taa=1
  measure motion "${view[@]}" --axis rt_denoiser=0 --axis rt_taa=0
}

check_finite() { # RECORDING
  local stats="$out/finite_$(basename "$1" .q3t).jsonl"
  "$program" replay "$1" --size "${SIZE:-320x240}" --set rt_checkFinite=1 --stats "$stats" "${game[@]}"
  grep -o '"nonfinite":{[^}]*}' "$stats" | sed 's/"nonfinite"://' | grep -o ':[0-9]*' |
    awk -F: -v name="$1" '{ sum += $2; if ($2 > 0) ++bad }
      END { printf "%s: %d counts, %d not 0, %d numbers in all\n", name, NR, bad, sum }'
}

# A line a point: the number of views; mean, 5th percentile and worst SSIM; mean FLIP; the settings.
summarize() { # FILE
  while IFS= read -r line; do
    local settings
    settings="$(grep -o '"settings":{[^}]*}' <<<"$line" | head -1 | tr -d '"{}' | cut -d: -f2-)"
    # Of each view a plain number; the mean of all is an object.
    grep -o '"ssim":[0-9.]*[0-9]' <<<"$line" | cut -d: -f2 | sort -n >"$out/ssim.tmp"
    local flip
    flip="$(grep -o '"flip":[0-9.e-]*[0-9]' <<<"$line" | cut -d: -f2 |
      awk '{ sum += $1 } END { printf "%.4f", sum / NR }')"
    awk -v name="$(basename "$1" .jsonl)" -v flip="$flip" -v settings="$settings" '
      { value[NR] = $1; sum += $1 }
      END { printf "%-22s %3d views  SSIM mean %.4f  5%% %.4f  worst %.4f  FLIP %s  %s\n", name, NR, sum / NR,
                   value[int((NR - 1) * 0.05) + 1], value[1], flip, settings }' "$out/ssim.tmp"
  done <"$1"
  rm -f "$out/ssim.tmp"
}

mode="${1:-}"
[ $# -eq 0 ] || shift
case "$mode" in
static)
  [ $# -gt 0 ] || set -- oa_shouse oa_dm1 fan oacmpdm9 hydronex
  for map in "$@"; do
    measure_still "$map"
    summarize "$out/static_$map.jsonl"
  done
  ;;
motion)
  measure_motion "${1:?a recording made by: build/q3rt record --demo demo088-test1 --first 600 --count 300 --out FILE}"
  summarize "$out/motion.jsonl"
  ;;
finite)
  for recording in "$@"; do
    check_finite "$recording"
  done
  ;;
summary)
  for file in "$out"/static_*.jsonl "$out"/motion.jsonl; do
    [ ! -e "$file" ] || summarize "$file"
  done
  ;;
*)
  sed -n '4,7s/^# *//p' "$0" >&2
  exit 2
  ;;
esac
