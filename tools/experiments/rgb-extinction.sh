#!/usr/bin/env bash
# xu2025 Fig. 14: PSNR of one extinction and of extinctions by channel at 10 samples per pixel, each against 4096 of its
# own. Prints a table and leaves the pictures in out/experiments/rgb-extinction/. [SIZE] is the picture's edge, 128 by default.
set -euo pipefail
cd "$(dirname "$0")/../.."

size=${1:-128} out=out/experiments/rgb-extinction program=build/release/voxlume
mkdir -p "$out"

# Translucent soft tissue over bone. Tissue lets red through; in the single picture its albedo alone is red.
cat > "$out/scene.json" <<JSON
{
  "version": 1,
  "volume": {"path": "$PWD/data/head-ct.nrrd"},
  "transfer": {
    "points": [
      {"value": -400, "opacity": 0, "color": "#f0c0a8", "extinction_color": {"linear": [0.4, 0.85, 1]}},
      {"value": -100, "opacity": 0.06, "color": "#f0c0a8", "extinction_color": {"linear": [0.4, 0.85, 1]}},
      {"value": 120, "opacity": 0.12, "color": "#e0a090", "extinction_color": {"linear": [0.4, 0.85, 1]}},
      {"value": 350, "opacity": 0.9, "color": "#eee3cf", "extinction_color": {"linear": [1, 1, 1]}}
    ]
  },
  "camera": {"azimuth_deg": 25, "elevation_deg": 10, "zoom": 1.4}
}
JSON

render() {  # render NAME EXTINCTION SPP SEED options...
  local name=$1 extinction=$2 spp=$3 seed=$4; shift 4
  "$program" render "$out/scene.json" -o "$out/$name.exr" --set "/render/extinction=$extinction" --spp "$spp" --seed "$seed" \
    --size "${size}x$size" "$@"
}
psnr() { "$program" compare "$1" "$2" --json | sed -n 's/.*"psnr": *\([0-9.]*\).*/\1/p'; }

printf '%-14s %12s %12s %8s\n' scatterings "single, dB" "rgb, dB" loss
for limit in 1 2 0; do
  declare -A mean=([single]=0 [rgb]=0)
  for extinction in single rgb; do
    render "$extinction-$limit-reference" "$extinction" 4096 99 --max-scatter "$limit"
    for seed in 1 2 3 4; do
      render "$extinction-$limit" "$extinction" 10 "$seed" --max-scatter "$limit"
      one=$(psnr "$out/$extinction-$limit.exr" "$out/$extinction-$limit-reference.exr")
      mean[$extinction]=$(awk "BEGIN{print ${mean[$extinction]} + $one / 4}")
    done
  done
  name=$limit; [ "$limit" != 0 ] || name="no limit"
  awk "BEGIN{printf \"%-14s %12.2f %12.2f %+8.2f\n\", \"$name\", ${mean[single]}, ${mean[rgb]}, ${mean[rgb]} - ${mean[single]}}"
done
echo "mean of 4 seeds; display PSNR against 4096 samples per pixel of the same extinction; pictures in $out"
