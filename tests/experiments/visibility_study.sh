#!/usr/bin/env bash
# The study of what hides the important, as small as can be: visibility_study.sh VOXLUME LIST_CONVERGENCE. Checks that every figure leaves a whole
# table, that lists converge, that a second run makes no picture again, and that the page has every part.
set -euo pipefail
export VOXLUME=$1 VOXLUME_LISTS=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { echo "visibility_study: $*" >&2; exit 1; }
command -v python3 >/dev/null || { echo "visibility_study: no python3; nothing to do"; exit 0; }

study() {
  python3 "$(dirname "$0")/../../tools/experiments/visibility_study.py" --folder "$folder" --edge 12 --samples 2 --ct phantom "$@" >/dev/null 2>"$folder/err" ||
    fail "$(cat "$folder/err")"
}
study
for figure in fig2:7 fig5:5 fig6:6 fig8:5 fig9:4 fig11:4 fig12:6 table3:4; do
  [ "$(wc -l < "$folder/${figure%:*}.csv")" = "${figure#*:}" ] || fail "${figure%:*}.csv has not ${figure#*:} lines"
done
awk -F, 'NR == 2 { first = $4 } END { exit !(first > 0.05 && $4 < 1e-5 && $5 < 1e-5) }' "$folder/fig7.csv" || fail "lists do not converge"
for part in "Fig. 2" "Fig. 5" "Fig. 6" "Fig. 7" "Fig. 8" "Fig. 9" "Fig. 11" "Fig. 12" "Table 3"; do
  grep -q "$part" "$folder/index.html" || fail "the page lacks $part"
done
! grep -qE '>(nan|None)<' "$folder/index.html" || fail "the page has values that are none"

study
[ ! -s "$folder/err" ] || fail "the second run made pictures again: $(cat "$folder/err")"
study --only 2,7
if python3 "$(dirname "$0")/../../tools/experiments/visibility_study.py" --only 3 --folder "$folder" 2>"$folder/err"; then fail "a figure that there is not is taken"; fi
grep -q "no figure 3" "$folder/err" || fail "$(cat "$folder/err")"
