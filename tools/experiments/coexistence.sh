#!/usr/bin/env bash
# xu2024 Fig. 3: PSNR of coexistence and Exposure Render shading at 3 samples per pixel against 1024, the same scene.
# Prints a table and leaves the pictures in out/experiments/coexistence/. [SIZE] is the picture's edge, 256 by default.
set -euo pipefail
cd "$(dirname "$0")/../.."

size=${1:-256} out=out/experiments/coexistence program=build/release/voxlume
mkdir -p "$out"

render() {  # render NAME SHADING SPP SEED INPUT options...
  local name=$1 shading=$2 spp=$3 seed=$4 input=$5; shift 5
  "$program" render "$input" -o "$out/$name.exr" --shading "$shading" --spp "$spp" --seed "$seed" --size "${size}x$size" "$@"
}
psnr() { "$program" compare "$1" "$2" --json | sed -n 's/.*"psnr": *\([0-9.]*\).*/\1/p'; }

printf '%-16s %12s %12s %8s\n' scene "er, dB" "coexist., dB" gain
scene() {  # scene NAME INPUT options...
  local name=$1 input=$2; shift 2
  local total_er=0 total_co=0 seeds="1 2 3 4"
  render "$name-reference" coexistence 1024 99 "$input" "$@"
  for seed in $seeds; do
    render "$name-er" er 3 "$seed" "$input" "$@"
    render "$name-coexistence" coexistence 3 "$seed" "$input" "$@"
    total_er=$(awk "BEGIN{print $total_er + $(psnr "$out/$name-er.exr" "$out/$name-reference.exr") / 4}")
    total_co=$(awk "BEGIN{print $total_co + $(psnr "$out/$name-coexistence.exr" "$out/$name-reference.exr") / 4}")
  done
  awk "BEGIN{printf \"%-16s %12.2f %12.2f %+8.2f\n\", \"$name\", $total_er, $total_co, $total_co - $total_er}"
}
scene ct-bone data/head-ct.nrrd --preset ct-bone --camera 25,10,1.4
scene ct-skin data/head-ct.nrrd --preset ct-skin --camera 25,10,1.4
scene ct-muscle-bone data/head-ct.nrrd --preset ct-muscle-bone --camera 25,10,1.4
scene mri-head data/mri-head.nii.gz --preset mri-head --camera 25,10,1.3
echo "mean of 4 seeds; display PSNR against 1024 samples per pixel of coexistence; pictures in $out"
