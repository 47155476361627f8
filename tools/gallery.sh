#!/usr/bin/env bash
# Renders every preset into out/gallery/, or, with --docs, the smaller pictures of the documentation into docs/pictures/.
set -euo pipefail
cd "$(dirname "$0")/.."

out=out/gallery size=640x640 spp=256
if [ "${1:-}" = --docs ]; then out=docs/pictures size=340x340 spp=350; fi
mkdir -p "$out"

picture() {  # picture NAME INPUT options...
  local name=$1 input=$2; shift 2
  printf 'gallery: %s\n' "$out/$name.png" >&2
  build/release/voxlume render "$input" -o "$out/$name.png" --size $size --spp $spp "$@"
}

ct=data/head-ct.nrrd mri=data/mri-head.nii.gz
picture ct-bone $ct --preset ct-bone --camera 25,10,1.4
picture ct-skin $ct --preset ct-skin --camera 25,10,1.4
picture ct-muscle-bone $ct --preset ct-muscle-bone --camera 25,10,1.4
picture fog $ct --preset fog --camera 25,10,1.4
picture mri-head $mri --preset mri-head --camera 25,10,1.3
picture generic $mri --preset generic --camera 25,10,1.3
picture labels data/mri-brain.nii.gz --preset mri-head --labels data/aal.nii.gz --camera 60,25,1.6
picture clip $ct --preset ct-muscle-bone --clip :,:,:10 --camera 20,50,1.4
picture environment $ct --preset ct-skin --env data/env/sunset.exr --background env --camera 25,5,1.4
for scene in head-materials brain-regions brodmann-areas fusion merge-product merge-priority illustration toon; do
  picture $scene examples/$scene.json
done
labels=$(mktemp -d)  # docs/transfer-functions.md: both outlines, side by side
for outline in voxels smooth; do
  printf 'gallery: labels with outline %s\n' $outline >&2
  build/release/voxlume render examples/brain-labels.json -o "$labels/$outline.png" --size 340x340 --spp $spp --set /proxies/0/outline=$outline
done
python3 tools/side_by_side.py "$labels/voxels.png" "$labels/smooth.png" 20,20,320,320 "$out/label-outlines.png" || echo "label-outlines.png needs python3 with Pillow" >&2
rm -rf "$labels"
picture visibility-off examples/visibility.json --set /visibility/important=[]  # docs/visibility.md
picture visibility-eye examples/visibility.json --visibility-lights off
picture visibility-light examples/visibility.json
picture self-occlusion-1 examples/head-materials.json
picture self-occlusion-03 examples/head-materials.json --set /material/self_occlusion=0.3
# xu2025 Fig. 13: one extinction and extinctions by channel; tools/experiments/rgb-extinction.sh measures their noise
for extinction in single rgb; do
  picture extinction-$extinction examples/extinction.json --set /render/extinction=$extinction
  spp=10 picture extinction-$extinction-10 examples/extinction.json --set /render/extinction=$extinction
done
sheet=$(mktemp -d)  # docs/peers.md
for method in vpl-dvr exposure-render rmss ar2t path; do
  printf 'gallery: by %s\n' "$method" >&2
  build/release/voxlume render $ct -o "$sheet/ct-bone $method.png" --size 200x200 --spp $spp --preset ct-bone \
    --camera 25,10,1.5 --env data/env/sunset.exr --background env --integrator $method
  build/release/voxlume render examples/head-materials.json -o "$sheet/head-materials $method.png" --size 200x200 \
    --spp $spp --env data/env/sunset.exr --background env --integrator $method
done
python3 tools/contact_sheet.py 5 "$out/peers.png" "$sheet" || echo "peers.png needs python3 with Pillow" >&2
rm -rf "$sheet"
materials=$(mktemp -d)
for material in $(build/release/voxlume materials | cut -d' ' -f1); do
  printf 'gallery: material %s\n' "$material" >&2
  build/release/voxlume render examples/material.json -o "$materials/$material.png" --size 170x170 --spp $spp \
    --set /transfer/rules/0/points/0/material="$material"
done
python3 tools/contact_sheet.py 6 "$out/materials.png" "$materials" || echo "materials.png needs python3 with Pillow" >&2
rm -rf "$materials"
if [ "$out" = docs/pictures ]; then size=720x480; fi
picture hero $ct --preset ct-muscle-bone --camera 35,12,1.5
if [ "$out" = docs/pictures ]; then  # docs/metrics.md
  few=$(mktemp --suffix .png)
  noisy=$(mktemp --suffix .png)
  trap 'rm -f "$few" "$noisy"' EXIT
  build/release/voxlume render $ct -o "$few" --size 340x340 --spp 4 --seed 5 --preset ct-muscle-bone --camera 25,10,1.4
  build/release/voxlume compare "$few" "$out/ct-muscle-bone.png" --metric flip --error-map "$out/flip.png" --error-map-kind flip
  # docs/denoising.md: both halves, side by side
  build/release/voxlume render $ct -o "$noisy" --size 640x640 --spp 4 --camera 25,10,1.4
  build/release/voxlume render $ct -o "$few" --size 640x640 --spp 4 --camera 25,10,1.4 --denoise decoupled
  python3 tools/side_by_side.py "$noisy" "$few" 190,330,470,580 "$out/denoise.png" || echo "denoise.png needs python3 with Pillow" >&2
fi
