#!/usr/bin/env bash
# The study of the denoisers, as small as can be: denoise_study.sh PROGRAM. Checks that it leaves whole tables, that a denoised
# picture is better than the noisy one, that a second run has nothing left to do and one with other options is refused, and that the page has every part.
set -euo pipefail
program=$1 folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
page=$(dirname "$0")/../../tools/experiments/denoise_page.py
fail() { echo "denoise_study: $*" >&2; exit 1; }

# OIDN is slow to start, and not what is tested.
study() {
  VOXLUME_OIDN_LIBRARY=/nonexistent "$program" "$folder" --width 48 --height 32 --frames 4 --every 4 --data phantom --media none \
    --animations orbit --reference-spp 16 --spp 1,2 --moments 3 --history 2 --seeds "${1:-2}" --rest 2 --sweep 1,4 >/dev/null 2>"$folder/err"
}
study || fail "the program failed"

table=$folder/over-time-phantom-orbit.csv
# noisy, five with or without history, wrls, rls, three variants of the decoupled one; A-SVGF needs gradient samples.
for spp in 1 2; do
  [ "$(awk -F, -v spp=$spp '$3 == spp' "$table" | wc -l)" -ge 10 ] || fail "$table lacks methods at $spp spp"
done
psnr() { awk -F, -v m="$1" '$5 == m && $3 == 1 { print $8; exit }' "$table"; }
awk -v a="$(psnr decoupled)" -v b="$(psnr noisy)" 'BEGIN { exit !(a > b + 3) }' || fail "decoupled gains less than 3 dB: $(psnr decoupled) over $(psnr noisy)"
[ "$(awk -F, 'NR > 1 && $4 >= 0' "$folder/classes.csv" | wc -l)" = 3 ] || fail "classes.csv lacks a row"
# More classes are never worse by much.
awk -F, 'NR == 2 { one = $3 } NR == 3 { exit !($3 < one) }' "$folder/classes.csv" || fail "two classes are no better than one"

before=$(ls -l --time-style=full-iso "$folder"/*.csv)
study || fail "the second run failed"
[ "$before" = "$(ls -l --time-style=full-iso "$folder"/*.csv)" ] || fail "the second run did something again"

if study 3; then fail "a folder of other options is taken over"; fi
grep -qF "error: $folder: has results of other options (--seeds 2 there, --seeds 3 now)" "$folder/err" || fail "$(cat "$folder/err")"
[ "$before" = "$(ls -l --time-style=full-iso "$folder"/*.csv)" ] || fail "it changed something all the same"
grep -q "2 pictures of the moment" "$folder/settings.txt" || fail "the settings are those of the run that was refused"

if command -v python3 >/dev/null; then
  python3 "$page" "$folder" || fail "no page"
  for part in Goals Summary "Over time" "Temporal variance" Ablations "parts of light" "Samples a pixel against" "not reproduced"; do
    grep -q "$part" "$folder/index.html" || fail "the page lacks: $part"
  done
  ! grep -qE '>(nan|None)<' "$folder/index.html" || fail "the page has values that are none"
fi
