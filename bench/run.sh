#!/usr/bin/env bash
# Builds and runs the benchmarks; JSON into out/bench/, named after the time: TIME.json, TIME-denoise.json
# for the denoisers, TIME-rules.json for look-ups and updates under rules, TIME-visibility.json and
# TIME-visibility-labels.json for keeping the important in view. [ROUNDS]
set -euo pipefail
cd "$(dirname "$0")/.."
ninja -C build/release voxlume_bench voxlume_denoise_speed voxlume_rules voxlume_visibility_speed >&2
mkdir -p out/bench
out=out/bench/$(date +%Y%m%d-%H%M%S).json
build/release/bench/voxlume_bench bench/scenes "${1:-5}" > "$out.part"
machine=$(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -n 1)
python3 - "$out.part" "$out" "$machine" <<'P' 2>/dev/null || mv "$out.part" "$out"
import json, sys
data = json.load(open(sys.argv[1])); data = {"machine": sys.argv[3], **data}
json.dump(data, open(sys.argv[2], "w"), indent=2)
P
rm -f "$out.part"
build/release/bench/voxlume_denoise_speed "${1:-5}" > "${out%.json}-denoise.json"
volume=data/mri-head.nii.gz
[ -f $volume ] || volume=data/head-ct.nrrd
build/release/bench/voxlume_rules $volume > "${out%.json}-rules.json"
speed=build/release/bench/voxlume_visibility_speed
$speed data/head-ct.nrrd "${1:-5}" > "${out%.json}-visibility.json"
if [ -f data/mri-head.nii.gz ] && [ -f data/aal.nii.gz ]; then
  $speed data/mri-head.nii.gz "${1:-5}" 800 data/aal.nii.gz=37,38 > "${out%.json}-visibility-labels.json"
fi
cat "$out" "${out%.json}"-*.json
echo "bench: $out" >&2
