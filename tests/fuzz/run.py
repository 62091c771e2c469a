#!/usr/bin/env python3
"""Fuzzes everything that reads files: builds the entries beside this script, makes their corpora, runs them.

  python3 tests/fuzz/run.py                          a minute for all together
  python3 tests/fuzz/run.py --seconds 3600 scene     an hour for one of them
  python3 tests/fuzz/run.py --runs 100000            so many inputs for each

It needs the build with sanitizers (build/debug). Corpora grow in build/fuzz/corpus; an input that ends a reader
by anything but its own refusal is kept in build/fuzz and told: `build/fuzz/fuzz_NAME FILE` shows it again. An input that
takes more than 10 s or 1 GB is one, too.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SANITIZED, BUILD = ROOT / "build" / "debug", ROOT / "build" / "fuzz"
ENTRIES = sorted(file.stem for file in Path(__file__).parent.glob("*.cpp"))


def build():
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    subprocess.run(["cmake", "-S", str(Path(__file__).parent), "-B", str(BUILD), "-G", "Ninja", "--log-level=WARNING",
                    "-DCMAKE_CXX_COMPILER=clang++", f"-DPOINSOT_BUILD={SANITIZED}", *launcher], check=True)
    subprocess.run(["ninja", "-C", str(BUILD), "--quiet"], check=True)


def strings_of(value):
    """All strings and numbers of a JSON document."""
    if isinstance(value, dict):
        for one in value.values():
            yield from strings_of(one)
    elif isinstance(value, list):
        for one in value:
            yield from strings_of(one)
    elif isinstance(value, (str, int, float)) and not isinstance(value, bool):
        yield str(value)


def without_comments(text):
    return re.sub(r'("(?:[^"\\]|\\.)*")|//[^\n]*', lambda match: match.group(1) or "", text)


def results(folder):
    """A chart and the rows of a study, as the program writes them."""
    program = SANITIZED / "app" / "poinsot"
    shutil.rmtree(folder, ignore_errors=True)
    common = ["--cache", str(folder / "cache"), "--quiet"]
    chart = subprocess.run([program, "chart", ROOT / "models" / "single_pendulum.json", "--quick", "--end", "0.1",
                            "--integrators", "implicit_euler,dop853", "--out", folder, *common], check=False)
    study = subprocess.run([program, "study", ROOT / "tests" / "fuzz" / "rows.json", "--threads", "1", "--out", folder,
                            *common], check=False)
    if 2 in (chart.returncode, study.returncode):
        sys.exit("no chart or no study to begin with")
    return (folder / "single_pendulum.csv").read_text(), (folder / "cases.part").read_text()


def seeds():
    """By entry: the inputs to begin with."""
    models = [file for file in sorted((ROOT / "models").glob("*.json")) if not file.name.endswith(".schema.json")]
    studies = sorted((ROOT / "bench" / "studies").glob("*.json"))
    found = {entry: [] for entry in ENTRIES}
    found["scene"] = [file.read_text() for file in models]
    found["study"] = [file.read_text() for file in studies]
    for file in models + studies:
        document = json.loads(without_comments(file.read_text()))
        found["expression"] += list(strings_of(document))
        if isinstance(document.get("settings"), dict):
            found["configuration"].append(json.dumps(document["settings"]))
    found["expression"] += ["abs(t - 1)*sin(2*pi*t)^2", "60*x + 3*v - min(x, 0)^3", "step(t)*exp(-t)/(1 + t)"]
    found["configuration"] += ['{"formulation": "rA", "integrator": "implicit_euler", "step": 1e-3, "end": 2}',
                               '{"formulation": "rp", "integrator": "ida", "rtol": 1e-6, "atol": 1e-9, "every": 0.1}']
    chart, rows = results(BUILD / "results")
    lines = chart.splitlines(keepends=True)
    found["chart"] = ["".join(line for line in lines if not line.startswith("#")), chart]
    body = [line for line in rows.splitlines() if not line.startswith("#")]
    found["rows"] = ["\n".join(line[16:] for line in body[:20]) + "\n", "\n".join(body[:3]) + "\n"]
    found["table"] = ["0,0\n0.5,1\n1,0.25\n", "x,y,z\n0,1,2\n1,2,3\n# a note\n2,1,1\n", "0;1\n", *found["chart"]]
    return found


def make_corpora():
    for entry, inputs in seeds().items():
        folder = BUILD / "corpus" / entry
        folder.mkdir(parents=True, exist_ok=True)
        for k, text in enumerate(dict.fromkeys(inputs)):
            (folder / f"seed{k}").write_text(text)


def fuzz(entry, limits):
    command = [str(BUILD / f"fuzz_{entry}"), str(BUILD / "corpus" / entry), *limits, "-timeout=10", "-rss_limit_mb=1024",
               "-max_len=16384", "-seed=20240613", f"-artifact_prefix={BUILD}/{entry}-", "-print_final_stats=1",
               "-verbosity=0"]
    began = time.monotonic()
    run = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    count = re.search(r"number_of_executed_units: (\d+)", run.stderr)
    print(f"{entry}: {count.group(1) if count else '?'} inputs in {time.monotonic() - began:.0f} s"
          f"{'' if run.returncode == 0 else ', FAILED'}", flush=True)
    if run.returncode != 0:
        print(run.stderr[-6000:], flush=True)
    return run.returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("entries", nargs="*", metavar="ENTRY", help=f"of {', '.join(ENTRIES)}; all where none is given")
    parser.add_argument("--seconds", type=int, default=60, help="for all together")
    parser.add_argument("--runs", type=int, help="inputs for each, in the place of a time")
    options = parser.parse_args()
    entries = options.entries or ENTRIES
    for entry in entries:
        if entry not in ENTRIES:
            parser.error(f'found "{entry}", expected some of {", ".join(ENTRIES)}')
    build()
    make_corpora()
    cores = min(os.cpu_count(), len(entries))
    seconds = max(1, options.seconds * cores // len(entries))
    limits = [f"-runs={options.runs}"] if options.runs else [f"-max_total_time={seconds}"]
    with ThreadPoolExecutor(cores) as pool:
        return 0 if all(list(pool.map(lambda entry: fuzz(entry, limits), entries))) else 1


if __name__ == "__main__":
    sys.exit(main())
