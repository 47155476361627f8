#!/usr/bin/env bash
# xu2025 Fig. 14: PSNR of one extinction and of extinctions by channel at 10 samples per pixel, each against 4096 of its
# own. Prints a table and leaves the pictures in out/experiments/rgb-extinction/. [SIZE] is the picture's edge, 128 by default.
set -euo pipefail
cd "$(dirname "$0")/../.."

size=${1:-128} out=out/experiments/rgb-extinction program=build/release/voxlume
mkdir -p "$out"

# Translucent soft tissue over bone. Tissue lets red through, some or much; in the single picture its albedo alone is red.
write_scene() {  # write_scene NAME TISSUE EXTINCTION
  cat > "$out/$1.json" <<JSON
{
  "version": 1,
  "volume": {"path": "$PWD/data/head-ct.nrrd"},
  "transfer": {
    "points": [
      {"value": -400, "opacity": 0, "color": "#f0c0a8", "extinction_color": {"linear": [$2]}},
      {"value": -100, "opacity": 0.06, "color": "#f0c0a8", "extinction_color": {"linear": [$2]}},
      {"value": 120, "opacity": 0.12, "color": "#e0a090", "extinction_color": {"linear": [$2]}},
      {"value": 350, "opacity": 0.9, "color": "#eee3cf", "extinction_color": {"linear": [1, 1, 1]}}
    ]
  },
  "camera": {"azimuth_deg": 25, "elevation_deg": 10, "zoom": 1.4},
  "render": {"extinction": "$3"}
}
JSON
}
write_scene single "1, 1, 1" single
write_scene some "0.4, 0.85, 1" rgb
write_scene much "0.1, 0.5, 1" rgb

render() {  # render SCENE NAME SPP SEED options...
  local scene=$1 name=$2 spp=$3 seed=$4; shift 4
  "$program" render "$out/$scene.json" -o "$out/$name.exr" --spp "$spp" --seed "$seed" --size "${size}x$size" "$@"
}
psnr() { "$program" compare "$1" "$2" --json | sed -n 's/.*"psnr": *\([0-9.]*\).*/\1/p'; }

printf '%-12s %10s %10s %10s\n' scatterings single some much
for limit in 1 2 0; do
  name=$limit; [ "$limit" != 0 ] || name="no limit"
  printf '%-12s' "$name"
  for scene in single some much; do
    mean=0
    render "$scene" "$scene-$limit-reference" 4096 99 --max-scatter "$limit"
    for seed in 1 2 3 4; do
      render "$scene" "$scene-$limit" 10 "$seed" --max-scatter "$limit"
      mean=$(awk "BEGIN{print $mean + $(psnr "$out/$scene-$limit.exr" "$out/$scene-$limit-reference.exr") / 4}")
    done
    printf ' %10.2f' "$mean"
  done
  echo
done
echo "dB, mean of 4 seeds; display PSNR against 4096 samples per pixel of the same scene; pictures in $out"
