#!/usr/bin/env bash
# Builds the fuzz targets of tests/fuzz with clang and runs each for SECONDS (60 by default). Corpora and findings stay in
# out/fuzz/. Fails when a target finds a crash, a leak or a hang.
set -euo pipefail
cd "$(dirname "$0")/.."

seconds=${1:-60}
cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_C_COMPILER=clang -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DVOXLUME_FUZZ=ON -DVOXLUME_TESTS=OFF -DVOXLUME_SANITIZE=fuzzer-no-link,address,undefined >/dev/null
names=$(cd tests/fuzz && basename -s .cpp fuzz_*.cpp)
# shellcheck disable=SC2086
ninja -C build/fuzz $names
status=0
for name in $names; do
  target=build/fuzz/tests/fuzz/$name
  mkdir -p "out/fuzz/$name"
  echo "fuzz: $name for $seconds s" >&2
  "$target" -max_total_time="$seconds" -rss_limit_mb=4096 -timeout=20 -artifact_prefix="out/fuzz/$name-" \
    "out/fuzz/$name" >"out/fuzz/$name.log" 2>&1 || { status=1; tail -n 30 "out/fuzz/$name.log" >&2; }
  grep -E '^Done|stat::' "out/fuzz/$name.log" >&2 || true
done
exit $status
