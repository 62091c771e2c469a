#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test: the release build first, then the build with address and
# undefined-behaviour sanitizers, whose readers of files are fuzzed for half a minute before its tests. Ends with ctest's
# summary, or at the first thing that fails.
set -euo pipefail
cd "$(dirname "$0")/.."
# A browser to look at the pages of `poinsot view` and `report`, MPI for studies, clang for fuzzing.
bash cmake/install_packages.sh chromium clang libopenmpi-dev openmpi-bin

# Layouts differ between versions of clang-format; the project's is that of Debian 12.
format=clang-format
if command -v clang-format-14 >/dev/null; then format=clang-format-14; fi
if ! "$format" --version | grep -q 'version 14\.'; then
  echo "the layout of the source is checked with clang-format 14, found: $("$format" --version)" >&2
  exit 1
fi
find core linsolve formulations integrators app bench tests \( -name '*.h' -o -name '*.cpp' \) -print0 |
  xargs -0 "$format" --dry-run --Werror
if command -v shellcheck >/dev/null; then
  shellcheck .ci/run bench/reproduce.sh cmake/install_packages.sh tests/run.sh
fi

jobs=$(nproc)
for preset in release debug; do
  cmake --preset "$preset" -G Ninja --log-level=WARNING
  cmake --build --preset "$preset" --parallel "$jobs"
  if [ "$preset" = debug ]; then python3 -B tests/fuzz/run.py --seconds 30; fi
  ctest --preset "$preset" --parallel "$jobs"
done
