"""Includes point one way: core <- linsolve <- formulations <- integrators <- bench/study <- bench/records <- bench/view <- bench/cases <- bench/stability <- bench/paper <-
bench/report <- app, and within integrators from the seam through stepping, start and methods to what stands beside them. The benchmark binaries,
bench/*, may include everything up to bench/study. Only the program knows CLI11. Prints every breach."""

import pathlib
import posixpath
import re
import sys

LAYERS = ["core", "linsolve", "formulations", "integrators", "bench/study", "bench/records", "bench/view", "bench/cases", "bench/stability", "bench/paper", "bench/report",
          "app"]
BENCHMARKS = "bench"  # tests may include anything


def layer_of(file):
    """The layer of a file or of what is included, the path from the root; nothing for what is not the project's."""
    for layer in LAYERS:
        if file.startswith(layer + "/"):
            return layer
    return BENCHMARKS if file.startswith(BENCHMARKS + "/") else None


def allowed(layer):
    if layer == BENCHMARKS:
        return LAYERS[: LAYERS.index("bench/study") + 1] + [BENCHMARKS]
    return LAYERS[: LAYERS.index(layer) + 1]


def breaches(root):
    for folder in sorted({layer.split("/")[0] for layer in LAYERS}):
        for path in sorted(path for path in (root / folder).rglob("*") if path.suffix in {".h", ".cpp"}):
            file = path.relative_to(root).as_posix()
            layer = layer_of(file)
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                included = re.match(r'\s*#\s*include\s*["<]([^">]+)[">]', line)
                if not included:
                    continue
                target = layer_of(posixpath.normpath(posixpath.join(posixpath.dirname(file), included[1]))
                                  if included[1].startswith(".") else included[1])
                if target and target not in allowed(layer):
                    yield f"{file}:{number}: {layer} must not include {target}: {line.strip()}"
                if included[1].startswith("CLI/") and layer != "app":
                    yield f"{file}:{number}: {layer} must not know the command line: {line.strip()}"


def rooms(root):
    """Within integrators: the seam <- stepping <- start <- methods <- what stands beside them."""
    order = ["seam", "stepping", "start", "methods", "beside"]
    seam = {"integrator.h", "jacobian_policy.h", "settings.h", "state.h", "stopping_test.h"}

    def room(file):  # below integrators/
        if "/" in file:
            return file.split("/")[0]
        return "seam" if file in seam else "beside"

    folder = root / "integrators"
    for path in sorted(path for path in folder.rglob("*") if path.suffix in {".h", ".cpp"}):
        own = room(path.relative_to(folder).as_posix())
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            included = re.match(r'\s*#\s*include\s*"integrators/([^"]+)"', line)
            if included and order.index(room(included[1])) > order.index(own):
                yield f"{path.relative_to(root)}:{number}: {own} must not include {room(included[1])}: {line.strip()}"


root = pathlib.Path(sys.argv[1])
found = list(breaches(root)) + list(rooms(root))
print("\n".join(found))
sys.exit(1 if found else 0)
