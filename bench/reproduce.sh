#!/usr/bin/env bash
# Installs what is missing, builds for this machine's processor, regenerates the paper's tables and figures into results/,
# measures what the paper has not, and writes the page that shows it all, results/report.html.
set -euo pipefail
cd "$(dirname "$0")/.."
bash cmake/install_packages.sh

cmake --preset native -G Ninja --log-level=WARNING -DPOINSOT_TESTS=OFF
cmake --build --preset native --parallel "$(nproc)"
mkdir -p results
build/native/app/poinsot tables --out results/
build/native/app/poinsot figures --out results/
build/native/app/poinsot chart models/{single_pendulum,double_pendulum,four_link,slider_crank}.json --quick --out results/
build/native/app/poinsot scale --bodies 1000 --out results/
build/native/app/poinsot study bench/studies/random_mechanisms.json --out results/random_mechanisms
build/native/app/poinsot report results/
