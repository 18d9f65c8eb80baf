#!/bin/bash
# Processor time that the engine takes in a timedemo, all its threads together.
#
#   play_processor_time.sh RENDERER [SIZE [DEMO [FIRST LAST]]]
#
# Milliseconds a frame between the frames FIRST and LAST (300 and 3300) of DEMO (demo088-test1) at SIZE (64x48): two
# runs end there, and their difference is free of loading. Needs a display, such as xvfb-run -a gives. Q3RT names the
# program.
set -euo pipefail
[ $# -ge 1 ] || { sed -n '2,8s/^# \?//p' "$0" >&2; exit 2; }
renderer="$1" size="${2:-64x48}" demo="${3:-demo088-test1}" first="${4:-300}" last="${5:-3300}"
program="${Q3RT:-build/q3rt}"
log="$(mktemp)"
trap 'rm -f "$log"' EXIT

for end in "$first" "$last"; do
  "$program" play --demo "$demo" --renderer "$renderer" --size "$size" --timedemo --frames "$end" --json >/dev/null
  times >>"$log" # of this shell: a substitution would count its own children
done
# Each second line has user and system time of all that has ended so far.
awk -v frames=$((last - first)) 'NR % 2 == 0 { gsub(/[ms]/, " "); total[NR] = $1 * 60 + $2 + $3 * 60 + $4 }
  END { printf "%.2f ms of processor time a frame\n", (total[4] - 2 * total[2]) * 1000 / frames }' "$log"
