#!/usr/bin/env bash
# Installs what is missing, builds for this machine's processor, regenerates the paper's tables and figures into results/,
# measures what the paper has not, and writes the page that shows it all, results/report.html.
set -euo pipefail
cd "$(dirname "$0")/.."
bash cmake/install_packages.sh

cmake --preset native -G Ninja --log-level=WARNING -DPOINSOT_TESTS=OFF
cmake --build --preset native --parallel "$(nproc)"
mkdir -p results

# What a folder holds already may be of another commit. A part that fails is told at the end, and the report is of the
# others.
failed=()
part() {
  local status=0
  build/native/app/poinsot "$@" || status=$?
  if ((status >= 128)); then exit "$status"; fi # interrupted
  if ((status != 0)); then failed+=("poinsot $*"); fi
}
part tables --out results/
part figures --out results/
part chart models/{single_pendulum,double_pendulum,four_link,slider_crank}.json --quick --fresh --out results/
part scale --bodies 1000 --out results/
part study bench/studies/random_mechanisms.json --fresh --out results/random_mechanisms
part report results/
if ((${#failed[@]} > 0)); then
  printf 'failed: %s\n' "${failed[@]}" >&2
  exit 1
fi
