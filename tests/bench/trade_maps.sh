#!/bin/bash
# What one light, denoiser and TAA are worth on a GPU, on maps with a hundred lights and more.
#
#   trade_maps.sh front [MAP...]  seven settings a map: a line of JSON each in $OUT/MAP.jsonl, one table of all maps;
#                                 whether one light with denoiser and TAA reaches SSIM 0.97 in a quarter of the time
#                                 of all culled lights, and whether the front beats two settings without culling
#   trade_maps.sh presets [MAP]   the sweep that renderer_rt/presets.def.h is made of, written there (or to PRESETS)
#
# Times are the device's own, after its clock has woken up. A killed run goes on where it stopped. Q3RT names the
# program, OUT the folder (default: trade_maps), GAME_ARGS the game data. Smaller trials: SIZE, VIEWS, AWAKE, SCALES,
# REFERENCE_FRAMES.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/../.."
program="${Q3RT:-build/q3rt}" out="${OUT:-trade_maps}"
read -r -a game <<<"${GAME_ARGS:-}"
common=(--clock device --warmup 32 --pictures 1 --reference-frames "${REFERENCE_FRAMES:-1024}"
  --reference-error 0.0005 "${game[@]}")
mkdir -p "$out"

field() { # JSON NAME: the number
  grep -o "\"$2\":[-0-9.e]*" <<<"$1" | head -1 | cut -d: -f2
}

# A row a point: map, lights, settings as one word, ms on the device, ms of wall time, SSIM, its interval, the error of
# the references, the upper quartile of ms on the device.
list_points() { # MAP
  while IFS= read -r line; do
    local settings ssim
    settings="$(grep -o '"settings":{[^}]*}' <<<"$line" | head -1)"
    ssim="$(grep -o '"ssim":{[^}]*}' <<<"$line" | head -1)"
    local which
    which="$(grep -o '"rt_\(numRandomDL\|cullLights\|denoiser\|taa\)":"[0-9]*"' <<<"$settings" | sort |
      sed 's/.*:"//; s/"//' | tr -d '\n')"
    echo "$1" "$(field "$line" lights)" "$which" \
      "$(field "$(grep -o '"gpu_ms":{[^}]*}' <<<"$line" | head -1)" median)" \
      "$(field "$(grep -o '"wall_ms":{[^}]*}' <<<"$line" | head -1)" median)" \
      "$(field "$ssim" value)" "$(field "$ssim" low)" "$(field "$ssim" high)" \
      "$(field "$(grep -o '"reference":{[^}]*}' <<<"$line")" error)" \
      "$(field "$(grep -o '"gpu_ms":{[^}]*}' <<<"$line" | head -1)" q3)"
  done <"$out/$1.jsonl"
}

# Settings are named by culling, denoiser, lights and TAA, a digit each.
judge() {
  awk '
    BEGIN {
      name["2010"] = "1 light, culled"; name["2111"] = "1 light, culled, denoiser, TAA"
      name["2000"] = "all lights, culled"; name["0010"] = "1 light, not culled"
      name["2110"] = "1 light, culled, denoiser"
      name["0000"] = "all lights, not culled"; name["0110"] = "1 light, not culled, denoiser"
      printf "%-12s %6s  %-32s %9s %9s  %s\n", "map", "lights", "setting", "device ms", "wall ms", "SSIM (95 %)"
    }
    {
      printf "%-12s %6d  %-32s %9.3f %9.3f  %.4f (%.4f - %.4f)\n", $1, $2, name[$3], $4, $5, $6, $7, $8
      if (!($1 in lights)) maps[++count] = $1
      lights[$1] = $2; ms[$1, $3] = $4; ssim[$1, $3] = $6; noise[$1] = $9; slow[$1, $3] = $10
    }
    # Does some setting of the map beat this one in time and likeness? What is below the error of the references
    # themselves is no difference, nor a time within the upper quartile of its own.
    function beaten(map, which,    other) {
      for (other in name)
        if (other != which && ms[map, other] <= slow[map, which] && ssim[map, other] >= ssim[map, which] - noise[map])
          return "yes"
      return "no"
    }
    END {
      print ""
      for (i = 1; i <= count; ++i) {
        map = maps[i]; share = ms[map, "2111"] / ms[map, "2000"]
        held = ssim[map, "2111"] >= 0.97 && share <= 0.25; all += held && lights[map] >= 100
        printf "%-12s one light, denoiser, TAA: SSIM %.4f in 1/%.1f of the time of all culled lights: %s; ", map,
               ssim[map, "2111"], 1 / share, held ? "holds" : "FAILS"
        printf "beaten: all lights not culled %s, one light not culled with denoiser %s\n", beaten(map, "0000"),
               beaten(map, "0110")
      }
      printf "%d of %d maps with 100 lights or more hold\n", all, count
    }'
}

mode="${1:-}"
[ $# -eq 0 ] || shift
case "$mode" in
front)
  [ $# -gt 0 ] || set -- oa_minia aggressor fan oacmpctf2
  for map in "$@"; do
    "$program" trade --map "$map" --at "spawn:0..$((${VIEWS:-3} - 1))" --size "${SIZE:-1280x720}" --points 7 \
      --awake "${AWAKE:-0.7}" --count 40 --seconds-per-point 6 "${common[@]}" --out "$out/$map.jsonl" \
      --svg "$out/$map.svg" >>"$out/tables.txt"
  done
  for map in "$@"; do
    list_points "$map"
  done | judge
  ;;
presets)
  scales="${SCALES:-50,55,60,65,70,75,80,85,90,95,100}"
  "$program" trade --map "${1:-oa_dm1}" --at "spawn:0..$((${VIEWS:-2} - 1))" --size "${SIZE:-960x540}" \
    --set rt_antialiasing=1 --axis rt_numRandomDL=1,2,4,0 --axis rt_denoiser=0,1 --axis rt_taa=0,1 \
    --axis "rt_scale=$scales" --axis rt_cullLights=2 --awake "${AWAKE:-0.3}" --count 20 --seconds-per-point 1 \
    "${common[@]}" --out "$out/presets.jsonl" --presets "${PRESETS:-renderer_rt/presets.def.h}"
  ;;
*)
  sed -n '4,7s/^# *//p' "$0" >&2
  exit 2
  ;;
esac
