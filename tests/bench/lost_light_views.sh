#!/bin/bash
# tests/bench/lost_light_views.sh MAP[:SPAWN]...: how bright renderer_rt draws a map without and with its lost lights,
# and renderer_vk draws it: mean luminance of 4 spawn points, or of the one named, a line of text a view. With
# PICTURES=DIR also before, after and opengl1 side by side, DIR/lost_MAP_SPAWN.jpg. With TABLE=FILE the lines are added
# to that file, and views that it has are not drawn again: work that was broken off goes on. Needs ImageMagick and Xvfb.
# All maps: tests/bench/lost_light_views.sh $(basename -s .ent renderer_rt/lights/baseoa/*.ent)
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
program="${Q3RT:-build/q3rt}" size="${SIZE:-160x120}" frames="${FRAMES:-8}" table="${TABLE:-/dev/null}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

draw() { # NAME ARGUMENTS...
  local name="$1"
  shift
  "$program" view --map "$map" --at "spawn:$spawn" --size "$size" --out "$work/$name.png" "$@" >/dev/null 2>&1
}
luminance() { convert "$work/$1.png" -colorspace Rec709Luma -format '%[fx:mean*255]' info:; }

echo "map spawn before after renderer_vk"
for which in "$@"; do
  map="${which%%:*}"
  spawns="0 1 2 3"
  [ "$map" = "$which" ] || spawns="${which#*:}"
  for spawn in $spawns; do
    ! grep -qs "^$map $spawn " "$table" || continue
    draw before --renderer rt --frames "$frames" --set rt_lostLights=0 || continue # fewer spawn points
    draw after --renderer rt --frames "$frames"
    draw vk --renderer vk
    printf '%s %s %.1f %.1f %.1f\n' "$map" "$spawn" "$(luminance before)" "$(luminance after)" "$(luminance vk)" |
      tee -a "$table"
    [ -n "${PICTURES:-}" ] || continue
    xvfb-run -a "$program" view --map "$map" --at "spawn:$spawn" --size "$size" --out "$work/gl.png" \
      --renderer /usr/lib/ioquake3/renderer_opengl1_x86_64.so >/dev/null 2>&1
    convert "$work"/{before,after,gl}.png +append -quality 88 "$PICTURES/lost_${map}_$spawn.jpg"
  done
done
