#!/usr/bin/env bash
# Variance times processor time of every choice of transmittance, free_flight and shadow_roulette, as a ratio to the
# default's: below 1 it is as good in less time. All run as scalar code on one thread over the same macrocells, but
# for "vector", the default as it runs when nothing is chosen: in vector lanes, over the hierarchy. The
# variance is that of a picture of 16 samples a pixel, from differences between independent seeds (stratified samples
# make the pictures' own estimate too great); the time is the processor's, without loading. [SIZE] is the picture's
# edge, [ROUNDS] the number of seeds. Leaves out/experiments/estimators/{table.csv,table.md}.
set -euo pipefail
cd "$(dirname "$0")/../.."

size=${1:-192} rounds=${2:-4} spp=16 out=out/experiments/estimators program=build/release/voxlume
mkdir -p "$out"
out_csv=$out/table.csv

scenes="ct-bone peer-1 peer-100 mri-head"
choices="default residual marching decomposition residual-decomposition roulette-0.25 roulette-1 vector"

scene_options() {
  case $1 in
    ct-bone) echo bench/scenes/ct-bone.json ;;
    peer-1) echo bench/scenes/peer.json --max-scatter 1 ;;
    peer-100) echo bench/scenes/peer.json --max-scatter 100 ;;
    mri-head) echo data/mri-head.nii.gz --preset mri-head --camera 25,10,1.3 ;;
  esac
}
choice_options() {
  [ "$1" = vector ] || echo --accel macrocell --simd scalar
  case $1 in
    default|vector) ;;
    residual) echo --set /render/transmittance=residual ;;
    marching) echo --set /render/transmittance=marching ;;
    decomposition) echo --set /render/free_flight=decomposition ;;
    residual-decomposition) echo --set /render/transmittance=residual --set /render/free_flight=decomposition ;;
    roulette-*) echo --set "/render/shadow_roulette=${1#roulette-}" ;;
  esac
}

processor_s() {  # processor_s SCENE CHOICE SPP SEED: renders, and prints the seconds it took
  local TIMEFORMAT=%U
  # shellcheck disable=SC2046
  { time "$program" render $(scene_options "$1") $(choice_options "$2") --threads 1 \
      --size "${size}x$size" --spp "$3" --seed "$4" -o "$out/$1-$2-$4.exr" --stats "$out/$1-$2-$4.json" \
      >/dev/null 2>"$out/log"; } 2>&1 || { cat "$out/log" >&2; return 1; }
}
count() { sed -n "s/.*\"$2\": *\([0-9.e+-]*\).*/\1/p" "$out/$1.json"; }
rmse() { "$program" compare "$out/$1.exr" "$out/$2.exr" --metric rmse --json | sed -n 's/.*"rmse": *\([0-9.e+-]*\).*/\1/p'; }

echo "scene,choice,seconds,look_ups_per_path,shadow_rays_per_path,variance,mean,relative_time,relative_variance,variance_x_time" >"$out_csv"
for scene in $scenes; do
  declare -A seconds=() loading=()
  for ((seed = 1; seed <= rounds; ++seed)); do
    for choice in $choices; do
      load=$(processor_s "$scene" "$choice" 1 "$seed")
      all=$(processor_s "$scene" "$choice" "$spp" "$seed")
      seconds[$choice]+="$all " loading[$choice]+="$load "
    done
  done
  base=
  for choice in $choices; do
    squares=
    for ((seed = 1; seed <= rounds; ++seed)); do squares+="$(rmse "$scene-$choice-$seed" "$scene-$choice-$((seed % rounds + 1))") "; done
    means=
    for ((seed = 1; seed <= rounds; ++seed)); do means+="$(count "$scene-$choice-$seed" mean_luminance) "; done
    name=$scene-$choice-1
    row=$(awk -v all="${seconds[$choice]}" -v load="${loading[$choice]}" -v squares="$squares" -v means="$means" -v base="$base" \
      -v spp="$spp" -v paths="$(count "$name" paths)" -v steps="$(count "$name" tracking_steps)" \
      -v shadows="$(count "$name" shadow_rays)" '
      function least(list,   a, n, i, m) { n = split(list, a, " "); m = a[1]; for (i = 2; i <= n; ++i) if (a[i] < m) m = a[i]; return m + 0 }
      BEGIN {
        t = (least(all) - least(load)) * spp / (spp - 1)
        n = split(squares, a, " "); for (i = 1; i <= n; ++i) v += a[i] * a[i] / 2 / n
        m = split(means, b, " "); for (i = 1; i <= m; ++i) mean += b[i] / m
        if (base == "") base = t " " v
        split(base, c, " ")
        printf "%.3f,%.2f,%.3f,%.4g,%.5g,%.2f,%.2f,%.2f\n", t, steps / paths, shadows / paths, v, mean, t / c[1], v / c[2], t * v / c[1] / c[2]
      }')
    [ -n "$base" ] || base=$(echo "$row" | awk -F, '{print $1, $4}')
    echo "$scene,$choice,$row" >>"$out_csv"
  done
done

awk -F, '
  NR == 1 { print "| scene | choice | time | variance | variance x time | look-ups per path | shadow rays per path |"; print "|---|---|---|---|---|---|---|"; next }
  { printf "| %s | %s | %s | %s | **%s** | %s | %s |\n", $1, $2, $8, $9, $10, $4, $5 }' "$out_csv" | tee "$out/table.md"
echo "time and variance relative to the default's; the table is also in $out"
