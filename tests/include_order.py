"""Includes point one way: core <- linsolve <- formulations <- integrators <- app, bench. Prints every breach."""

import pathlib
import re
import sys

LAYERS = ["core", "linsolve", "formulations", "integrators"]
TOPS = ["app", "bench"]  # tests may include anything


def breaches(root):
    for layer in LAYERS + TOPS:
        allowed = LAYERS[: LAYERS.index(layer) + 1] if layer in LAYERS else LAYERS + TOPS
        for file in sorted(path for path in (root / layer).rglob("*") if path.suffix in {".h", ".cpp"}):
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                included = re.match(r'\s*#\s*include\s*["<](?:\.\.?/)*(\w+)/', line)
                if included and included[1] in LAYERS + TOPS and included[1] not in allowed:
                    yield f"{file.relative_to(root)}:{number}: {layer} must not include {included[1]}: {line.strip()}"


found = list(breaches(pathlib.Path(sys.argv[1])))
print("\n".join(found))
sys.exit(1 if found else 0)
