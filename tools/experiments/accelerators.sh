#!/usr/bin/env bash
# xu2025 Table 5 and Fig. 5: what the accelerators cost, on the head CT and the MRI head; how fast updates are; the octree's
# nodes level by level. CSV, markdown and the picture into out/experiments/accelerators/. [EDGE of the picture] [ROUNDS]
set -euo pipefail
cd "$(dirname "$0")/../.."

edge=${1:-256} rounds=${2:-5} out=out/experiments/accelerators programs=build/release/bench
mkdir -p "$out"
ninja -C build/release voxlume_accelerators voxlume_hierarchy_update voxlume_hierarchy_levels >&2

csv=$out/accelerators.csv
echo 'volume,accelerator,"update, ms","nearest and farthest, ms","global illumination, ms","look-ups/path","M paths/s"' >"$csv"
for volume in head-ct.nrrd mri-head.nii.gz; do
  "$programs/voxlume_accelerators" "data/$volume" "$edge" "$rounds" >>"$csv"
done
{
  echo "| volume | accelerator | update, ms | nearest and farthest, ms | global illumination, ms | look-ups/path | M paths/s |"
  echo "|---|---|---|---|---|---|---|"
  # Names hold commas and are quoted.
  sed -n '2,$p' "$csv" | awk -F'"' '{ sub(/,$/, "", $1); sub(/^,/, "", $3); gsub(/,/, " | ", $3); print "| " $1 " | " $2 " | " $3 " |" }'
} >"$out/accelerators.md"
"$programs/voxlume_hierarchy_update" data/head-ct.nrrd >"$out/updates.md"
"$programs/voxlume_hierarchy_levels" data/head-ct.nrrd "$out/levels.png" >"$out/levels.md"
cat "$out/accelerators.md" "$out/updates.md"
echo "$edge x $edge pixels; updates on all threads, the rest one thread's processor time, medians of $rounds rounds; in $out"
