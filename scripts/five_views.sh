#!/bin/bash
# scripts/five_views.sh MAP:SPAWN...: a view without illumination, with one light a pixel, with one light filtered, with
# all lights, and accumulated, side by side: docs/pictures/five_MAP.jpg (figure 7.3 of the ray-traced Quake III thesis).
# Needs ImageMagick.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
program="${Q3RT:-build/q3rt}" size="${SIZE:-320x240}" accumulated="${FRAMES:-256}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
for which in "$@"; do
  map="${which%%:*}" spawn="${which#*:}"
  draw() { # NAME FRAMES SETTING...
    local name="$1" frames="$2" settings=()
    shift 2
    for setting in "$@"; do settings+=(--set "$setting"); done
    "$program" view --map "$map" --at "spawn:$spawn" --renderer rt --size "$size" --frames "$frames" "${settings[@]}" \
      --out "$work/$name.png" >/dev/null 2>&1
  }
  plain=(rt_denoiser=0 rt_taa=0)
  draw 1 1 "${plain[@]}" rt_illumination=0
  draw 2 1 "${plain[@]}"
  draw 3 32
  draw 4 1 "${plain[@]}" rt_numRandomDL=0
  draw 5 "$accumulated" rt_accumulate=1 rt_antialiasing=1
  convert "$work"/{1,2,3,4,5}.png +append -quality 88 "docs/pictures/five_$map.jpg"
done
