#!/bin/bash
# scripts/fuzz.sh SECONDS [TARGET...]: builds the fuzz targets with clang and runs each for SECONDS, as many at a time as
# there are cores. Inputs that failed stay in build-fuzz/findings/; inputs that reached new code are kept in
# build-fuzz/corpus/ and start the next run. Exit 1 if a target crashed, ran out of memory or time, or a sanitizer spoke.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
. scripts/setup.sh
readonly kSeconds="${1:?seconds for each target}"
shift

command -v clang++ >/dev/null || fail "clang++ is missing: apt-get install clang"
targets=("$@")
if [ ${#targets[@]} = 0 ]; then
  configureProgram build-fuzz -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ -DQ3RT_FUZZ=ON
  mapfile -t targets < <(ninja -C build-fuzz -t targets all | sed -n 's/^\(fuzz_[a-z0-9_]*\): phony$/\1/p' | sort -u)
fi
[ ${#targets[@]} -gt 0 ] || fail "there are no fuzz targets in build-fuzz"
compileProgram build-fuzz "${targets[@]}"

runTarget() {
  local target="$1" corpus="build-fuzz/corpus/$1" findings="build-fuzz/findings/$1" seeds=()
  mkdir -p "$corpus" "$findings"
  [ -d "tests/fuzz/seeds/${target#fuzz_}" ] && seeds=("tests/fuzz/seeds/${target#fuzz_}")
  if "build-fuzz/$target" "-max_total_time=$kSeconds" -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 \
    "-artifact_prefix=$findings/" "$corpus" "${seeds[@]}" >"$findings/log" 2>&1; then
    echo "   $target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$findings/log") inputs, nothing found"
  else
    tail -n 30 "$findings/log"
    echo "   $target: FAILED, see $findings"
    return 1
  fi
}

step "fuzzing ${#targets[@]} targets for $kSeconds s each"
status=0
running=0
for target in "${targets[@]}"; do
  if [ "$running" -ge "$(nproc)" ]; then
    wait -n || status=1
    running=$((running - 1))
  fi
  runTarget "$target" &
  running=$((running + 1))
done
while [ "$running" -gt 0 ]; do
  wait -n || status=1
  running=$((running - 1))
done
exit "$status"
