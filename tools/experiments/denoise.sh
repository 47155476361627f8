#!/usr/bin/env bash
# The denoisers compared (xu2024 6.2 to 6.4 and Figs. 6, 7, 9 to 13; iglesias2020 Figs. 14 to 19): sequences of the head CT and the
# MRI at 2 and 30 samples a pixel, every fourth frame against a reference of 512. CSVs, pictures and one page in
# out/experiments/denoise/. What is there is kept, so that a study that was interrupted goes on. --full has the papers' sizes, takes days and
# goes to out/experiments/denoise-full/. Other options: those of voxlume_denoise_study.
set -euo pipefail
cd "$(dirname "$0")/../.."

out=out/experiments/denoise
for option in "$@"; do [ "$option" = --full ] && out=out/experiments/denoise-full; done
mkdir -p "$out"
ninja -C build/release voxlume_denoise_study >&2
build/release/experiments/voxlume_denoise_study "$out" "$@"
python3 tools/experiments/denoise_page.py "$out"
cat "$out/summary.md"
echo "the page is $out/index.html"
