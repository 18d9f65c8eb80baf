#!/bin/bash
# tests/bench/lost_light_views.sh MAP[:SPAWN]...: how bright renderer_rt draws a map without and with its lost lights,
# and renderer_vk draws it: mean luminance (0 to 255) of 4 spawn points, or of the one named, a line of text a view; and
# the share of the picture, in percent, that renderer_vk shows lit (16 and more) and renderer_rt black (below 2), with
# grain averaged away. BEFORE=0 leaves the first out. With PICTURES=DIR also before, after and opengl1 side by side,
# DIR/lost_MAP_SPAWN.jpg. With TABLE=FILE the lines are added to that file, and views that it has are not drawn again:
# work that was broken off goes on. SETTINGS: more arguments for renderer_rt ("--set rt_backend=compute" is the quickest
# on a software driver). Needs ImageMagick and Xvfb.
# All maps: tests/bench/lost_light_views.sh $(basename -s .ent renderer_rt/lights/baseoa/*.ent)
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
program="${Q3RT:-build/q3rt}" size="${SIZE:-160x120}" frames="${FRAMES:-8}" table="${TABLE:-/dev/null}"
read -r -a settings <<<"${SETTINGS:-}"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT

draw() { # NAME ARGUMENTS...
  local name="$1"
  shift
  "$program" view --map "$map" --at "spawn:$spawn" --size "$size" --out "$work/$name.png" "$@" >/dev/null 2>&1
}
luminance() { convert "$work/$1.png" -colorspace Rec709Luma -format '%[fx:mean*255]' info:; }
black_share() {
  local smooth="-blur 0x2 -colorspace Rec709Luma -threshold"
  # shellcheck disable=SC2086 # words on purpose
  convert "(" "$work/vk.png" $smooth 6.3% ")" "(" "$work/after.png" $smooth 0.8% -negate ")" \
    -compose multiply -composite -format '%[fx:mean*100]' info:
}

echo "map spawn before after renderer_vk black"
for which in "$@"; do
  map="${which%%:*}"
  spawns="0 1 2 3"
  [ "$map" = "$which" ] || spawns="${which#*:}"
  for spawn in $spawns; do
    ! grep -qs "^$map $spawn " "$table" || continue
    draw vk --renderer vk || continue # fewer spawn points
    before="-"
    if [ "${BEFORE:-1}" != 0 ]; then
      draw before --renderer rt --frames "$frames" --set rt_lostLights=0 "${settings[@]}"
      before="$(printf %.1f "$(luminance before)")"
    fi
    draw after --renderer rt --frames "$frames" "${settings[@]}"
    printf '%s %s %s %.1f %.1f %.1f\n' "$map" "$spawn" "$before" "$(luminance after)" "$(luminance vk)" \
      "$(black_share)" | tee -a "$table"
    [ -n "${PICTURES:-}" ] || continue
    xvfb-run -a "$program" view --map "$map" --at "spawn:$spawn" --size "$size" --out "$work/gl.png" \
      --renderer /usr/lib/ioquake3/renderer_opengl1_x86_64.so >/dev/null 2>&1
    convert "$work"/{before,after,gl}.png +append -quality 88 "$PICTURES/lost_${map}_$spawn.jpg"
  done
done
