#!/bin/sh
# Runs every libFuzzer target for the given number of seconds, two at a time.
# Usage: tests/fuzz/run_fuzzers.sh SECONDS [BUILD_FOLDER] [TARGET...]
# The build folder (default build-fuzz) is made with clang. New inputs stay in its grown_corpus, so that long runs add
# up; an input that crashes is left in its crashes folder. Q3RT_FUZZ_SEED=N repeats one sequence of inputs.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
seconds=${1:-}
case $seconds in
    ''|*[!0-9]*) echo "usage: $0 SECONDS [BUILD_FOLDER] [TARGET...]" >&2; exit 2 ;;
esac
build=${2:-$root/build-fuzz}
[ $# -lt 2 ] && shift $# || shift 2
if ! command -v clang++ >/dev/null; then
    echo "error: clang++ is missing; install it with: apt-get install clang" >&2
    exit 1
fi
mkdir -p "$build"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_COMPILER=clang \
    -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_CXX_FLAGS=-Wno-unknown-warning-option -DQ3RT_FUZZ=ON \
    >"$build/build.log" 2>&1 || { tail -20 "$build/build.log" >&2; exit 1; }
cmake --build "$build" --target q3rt_fuzzers >"$build/build.log" 2>&1 || { tail -40 "$build/build.log" >&2; exit 1; }
build=$(cd "$build" && pwd)
"$build/make_corpus" "$build/fuzz_seeds"
mkdir -p "$build/grown_corpus" "$build/crashes"

if [ $# -eq 0 ]; then
    set -- $(cd "$root/tests/fuzz" && ls fuzz_*.cpp | sed 's/^fuzz_//; s/\.cpp$//')
fi

# One target: quiet unless it fails.
cat >"$build/run_one_fuzzer.sh" <<'ONE'
name=$1 build=$2 seconds=$3
seed=${Q3RT_FUZZ_SEED:-0}
mkdir -p "$build/grown_corpus/$name" "$build/fuzz_seeds/$name"
log=$build/fuzz_$name.log
if "$build/fuzz_$name" -seed="$seed" -max_total_time="$seconds" -timeout=25 -rss_limit_mb=2048 -print_final_stats=1 \
    -artifact_prefix="$build/crashes/$name-" "$build/grown_corpus/$name" "$build/fuzz_seeds/$name" >"$log" 2>&1; then
    echo "fuzz $name: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs in $seconds s, no crash"
else
    tail -40 "$log"
    echo "fuzz $name: FAILED; the input is in $build/crashes, the log is $log"
    exit 1
fi
ONE
printf '%s\n' "$@" | xargs -P 2 -I NAME sh "$build/run_one_fuzzer.sh" NAME "$build" "$seconds"
