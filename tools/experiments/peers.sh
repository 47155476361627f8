#!/usr/bin/env bash
# xu2025 Fig. 11: four scenes by other renderers' methods and by path tracing, side by side under an environment. Prints
# and writes a table (seconds; PSNR and FLIP against path tracing without a limit of scatterings; noise) and a page with the
# pictures into out/experiments/peers/. [SIZE] is the pictures' edge, 320 by default; [SPP] 128. Their ratings by people
# (Fig. 12, Table 4) are not repeated.
set -euo pipefail
cd "$(dirname "$0")/../.."

size=${1:-320} spp=${2:-128} out=out/experiments/peers program=build/release/voxlume
mkdir -p "$out"
methods="vpl-dvr exposure-render rmss ar2t path"
csv=$out/peers.csv page=$out/index.html
echo "scene,method,seconds,psnr_db,flip,noise_db" > "$csv"

number() { sed -n "s/.*\"$1\": *\([0-9.e+-]*\).*/\1/p" "$2" | head -n 1; }

picture() {  # picture NAME INPUT options...
  local name=$1 input=$2; shift 2
  "$program" render "$input" -o "$out/$name.png" --size "${size}x$size" --stats "$out/$name.json" \
    --env data/env/sunset.exr --background env "$@"
}
against() {  # against A B METRIC
  "$program" compare "$out/$1.png" "$out/$2.png" --metric "$3" --json | sed -n "s/.*\"$3\": *\([0-9.]*\).*/\1/p"
}

cat > "$page" <<HTML
<!doctype html><meta charset="utf-8"><title>Other renderers' methods</title>
<style>body{font:14px sans-serif;margin:2em}td,th{padding:4px;text-align:center}img{width:${size}px;max-width:18vw}</style>
<h1>Four scenes by other renderers' methods (xu2025 Fig. 11)</h1>
<p>$spp samples per pixel, $size x $size. FLIP against path tracing without a limit of scatterings; noise is the PSNR of two
pictures of different seeds. What the methods are: docs/peers.md.</p><table><tr><th></th>$(printf '<th>%s</th>' $methods)</tr>
HTML
printf '%-16s %-16s %8s %10s %8s %10s\n' scene method seconds "PSNR, dB" FLIP "noise, dB"
scene() {  # scene NAME INPUT options...
  local name=$1 input=$2 method seconds psnr flip noise; shift 2
  picture "$name-reference" "$input" --max-scatter 0 --spp $((4 * spp)) --seed 99 "$@"
  echo "<tr><th>$name</th>" >> "$page"
  for method in $methods; do
    picture "$name-$method" "$input" --integrator "$method" --spp "$spp" --seed 1 "$@"
    picture "$name-other" "$input" --integrator "$method" --spp "$spp" --seed 2 "$@"
    seconds=$(number total_s "$out/$name-$method.json")
    psnr=$(against "$name-$method" "$name-reference" psnr)
    flip=$(against "$name-$method" "$name-reference" flip)
    noise=$(against "$name-$method" "$name-other" psnr)
    printf '%-16s %-16s %8.2f %10.2f %8.4f %10.2f\n' "$name" "$method" "$seconds" "$psnr" "$flip" "$noise"
    echo "$name,$method,$seconds,$psnr,$flip,$noise" >> "$csv"
    printf '<td><img src="%s" alt="%s by %s"><br>%.1f s, FLIP %.3f</td>\n' \
      "$name-$method.png" "$name" "$method" "$seconds" "$flip" >> "$page"
  done
  echo "</tr>" >> "$page"
  rm -f "$out/$name-other".*
}
scene ct-bone data/head-ct.nrrd --preset ct-bone --camera 25,10,1.4
scene ct-muscle-bone data/head-ct.nrrd --preset ct-muscle-bone --camera 25,10,1.4
scene head-materials examples/head-materials.json
scene brain-regions examples/brain-regions.json
echo "</table>" >> "$page"
echo "pictures and table: $page, $csv"
