#!/usr/bin/env bash
# Finds the hierarchy's best settings for a scene: tries finest cells, look-up costs and thresholds and prints the fastest
# first. SCENE_OR_VOLUME [EDGE of the picture] [ROUNDS]; give them to voxlume render with --set.
set -euo pipefail
cd "$(dirname "$0")/../.."

ninja -C build/release voxlume_tune_hierarchy >&2
build/release/bench/voxlume_tune_hierarchy "${1:-bench/scenes/ct-bone.json}" "${@:2}"
