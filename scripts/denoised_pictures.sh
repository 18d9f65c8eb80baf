#!/bin/bash
# scripts/denoised_pictures.sh: one sample, denoised, reference, and FLIP's error of the denoised one as a heat map,
# side by side, of four still views, into docs/pictures/. Needs ImageMagick. REFERENCE_FRAMES (256) are averaged.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
program="${Q3RT:-build/q3rt}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
mkdir -p docs/pictures

draw() { # FRAMES OUT ARGUMENT...
  "$program" view "${view[@]}" --size 320x240 --set rt_antialiasing=1 --frames "$1" --out "$work/$2.png" "${@:3}"
}

while IFS='|' read -r name map place; do
  view=(--map "$map" --at "$place")
  draw 1 noisy --set rt_denoiser=0 --set rt_taa=0
  draw 32 denoised
  draw "${REFERENCE_FRAMES:-256}" reference --set rt_accumulate=1 --set rt_numRandomDL=4
  echo "$name: noisy $("$program" compare "$work/reference.png" "$work/noisy.png")"
  echo "$name: denoised $("$program" compare "$work/reference.png" "$work/denoised.png" --heatmap "$work/heat.png")"
  convert "$work"/{noisy,denoised,reference,heat}.png +append -quality 88 "docs/pictures/denoised_$name.jpg"
done <<'VIEWS'
oa_shouse|oa_shouse|spawn:7
fan|fan|spawn:2
oacmpdm9|oacmpdm9|spawn:5
hydronex|hydronex|704 -2976 98 0 90
VIEWS
