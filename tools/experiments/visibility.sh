#!/usr/bin/env bash
# The figures of lerzer2025 on the head CT and an MRI with an atlas: step sizes, lists, equal time against ray marching, errors over samples, lights,
# parameters, thin shells, memory. CSVs, pictures and one page in out/experiments/visibility/. What is there is kept, so that a study that was
# interrupted goes on. --full has the paper's sizes, takes hours and goes to out/experiments/visibility-full/; --only 2,8 makes some figures.
set -euo pipefail
cd "$(dirname "$0")/../.."

ninja -C build/release voxlume voxlume_list_convergence >&2
python3 tools/experiments/visibility_study.py "$@"
