#!/usr/bin/env bash
# Installs the Debian packages that building and testing need, those that are missing only, and says which. Arguments are
# further packages.
set -euo pipefail

packages=(
  g++ cmake ninja-build git                                     # build
  libeigen3-dev libsuitesparse-dev libsundials-dev              # numerics
  nlohmann-json3-dev libcli11-dev libfmt-dev                    # files and command line
  libgtest-dev libgmock-dev libbenchmark-dev                    # tests and benchmarks
  python3 python3-jsonschema python3-matplotlib clang-format    # schema, plots, layout of the source
)
# npm comes from elsewhere, too: the page of `poinsot view` is bundled with it.
command -v npm >/dev/null || packages+=(npm)
packages+=("$@")

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    echo "missing packages: ${missing[*]}; install them, or run this as root or with sudo" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq </dev/null
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}" </dev/null
