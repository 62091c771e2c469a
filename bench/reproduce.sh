#!/usr/bin/env bash
# Installs what is missing, builds for this machine's processor, and regenerates the paper's tables and figures
# into results/.
set -euo pipefail
cd "$(dirname "$0")/.."
bash cmake/install_packages.sh

cmake --preset native -G Ninja --log-level=WARNING -DPOINSOT_TESTS=OFF
cmake --build --preset native --parallel "$(nproc)"
mkdir -p results
build/native/app/poinsot tables --out results/
build/native/app/poinsot figures --out results/
