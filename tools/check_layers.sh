#!/usr/bin/env bash
# Fails when a file in src/ includes a layer that comes after its own in CMakeLists.txt's voxlume_layer() calls.
set -euo pipefail
cd "$(dirname "$0")/.."
layers=$(sed -n 's/^voxlume_layer(\([a-z_]*\).*/\1/p' CMakeLists.txt)
bad=0
allowed=
for layer in $layers; do
  allowed="$allowed $layer"
  while IFS= read -r line; do
    [ -n "$line" ] || continue
    file=${line%%:*}
    used=$(sed 's/.*#include "\([a-z_]*\)\/.*/\1/' <<<"$line")
    [ "$used" = voxlume ] && continue
    case " $allowed " in
      *" $used "*) ;;
      *) echo "$file: layer $layer may not include $used/ (allowed:$allowed)" >&2; bad=1 ;;
    esac
  done < <(grep -RHE '^#include "[a-z_]+/' "src/$layer" 2>/dev/null || true)
done
for folder in src/*/; do
  name=$(basename "$folder")
  grep -qx "$name" <<<"$layers" || { echo "$folder: not a layer of CMakeLists.txt" >&2; bad=1; }
done
[ $bad = 0 ] && echo "layers: includes go one way"
exit $bad
