#!/bin/bash
# scripts/pictures.sh RECORDING.q3t [FRAME...]: the same demo frames by opengl1, renderer_vk and renderer_rt, side by
# side, into docs/pictures/. Needs ImageMagick and Xvfb. The ray tracer draws 32 frames first: its history.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
recording="${1:?a recording made by: build/q3rt record --demo demo088-test1 --out FILE}"
shift
[ $# -gt 0 ] || set -- 330 750 1310 2010 2850
readonly kSize=400x300 kOpenGl=/usr/lib/ioquake3/renderer_opengl1_x86_64.so
program="${Q3RT:-build/q3rt}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
mkdir -p docs/pictures
for frame in "$@"; do
  name="$(printf '%08d' "$frame")"
  chosen=(--size $kSize --first "$frame" --count 1)
  xvfb-run -a "$program" replay "$recording" --renderer "$kOpenGl" "${chosen[@]}" --out "$work/gl"
  "$program" replay "$recording" --renderer vk "${chosen[@]}" --out "$work/vk"
  "$program" replay "$recording" --renderer rt --warmup 32 "${chosen[@]}" --out "$work/rt"
  convert "$work"/{gl,vk,rt}/"$name.png" +append -quality 88 "docs/pictures/demo_$name.jpg"
  likeness="$("$program" compare "$work/gl/$name.png" "$work/vk/$name.png")"
  echo "$frame: renderer_vk against opengl1 $likeness"
done
