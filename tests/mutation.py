#!/usr/bin/env python3
"""Would the tests notice? Applies the mutations of tests/mutations.json one at a time and runs the tests named with each.

  python3 tests/mutation.py                    all of them; hours, by hand or at night
  python3 tests/mutation.py --only 'rattle|ida'  those whose name or file matches
  python3 tests/mutation.py --check            only whether every text is found exactly once (in ctest, too)

A mutation is a text that stands exactly once in a file, what takes its place, and the tests that should fail on it:
"FILE" of tests/, all of it, or "FILE:GTEST_FILTER". They are applied to a copy of the sources (build/mutation), in which
only the executables that hold them are built, with the project's warnings: what a mutation leaves unused is an error. Printed is which were caught, by
which test, and which escaped; a mutation that escapes, does not compile or does not apply any more is a failure: a test
is missing, or the list has to follow the source.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LEFT_OUT = {"build", ".git", "results", "__pycache__", "node_modules"}
SUITES = "registry_suites_test"  # the executable of several files (CMakeLists.txt)
LONGEST = 900  # s, of a test without a mutation
SLOWER = 10  # times that, and half a minute: one that does not come to its end has noticed, too


def read_mutations():
    return json.loads((ROOT / "tests" / "mutations.json").read_text(encoding="utf-8"))


def faults_of(mutations):
    """What is wrong with the list, sentence by sentence."""
    names = [mutation["name"] for mutation in mutations]
    said = [f"{name}: stands twice in the list" for name in sorted(set(names)) if names.count(name) > 1]
    for mutation in mutations:
        file = ROOT / mutation["file"]
        count = file.read_text(encoding="utf-8").count(mutation["find"]) if file.is_file() else 0
        if count != 1:
            said.append(f"{mutation['name']}: its text is found {count} times in {mutation['file']}, expected once")
        if mutation["find"] == mutation["replace"]:
            said.append(f"{mutation['name']}: changes nothing")
        for test in mutation["tests"]:
            target = test.split(":")[0]
            if not (ROOT / "tests" / f"{target}.cpp").is_file() and target != SUITES:
                said.append(f"{mutation['name']}: there is no test {test}")
        if not mutation["tests"]:
            said.append(f"{mutation['name']}: no test should notice it")
    return said


class Scratch:
    """The copy of the sources and its build."""

    def __init__(self, folder, jobs):
        self.folder, self.build, self.jobs = folder, folder / "build" / "release", jobs
        self.longest = {}  # s, by test
        self.copy()
        if not (self.build / "build.ninja").exists():
            launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
            subprocess.run(["cmake", "--preset", "release", "-G", "Ninja", "--log-level=WARNING",
                            "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", *launcher], cwd=folder, check=True)
        else:  # a file of tests may have come or gone
            subprocess.run(["cmake", str(self.build), "--log-level=WARNING"], check=True, stdout=subprocess.DEVNULL)
        self.holders = self.holders_of_tests()

    def holders_of_tests(self):
        """The executable that a file of tests is compiled into, with others."""
        found = {}
        for group in self.build.glob("tests/CMakeFiles/*.dir/Unity/unity_*.cxx"):
            for name in re.findall(r'/tests/(\w+)\.cpp"', group.read_text(encoding="utf-8")):
                found[name] = group.parent.parent.name.removesuffix(".dir")
        return found

    def holder(self, test):
        name = test.partition(":")[0]
        return self.holders.get(name, name)

    def filter(self, test):
        """That of the test, or of all that stands in its file."""
        name, _, chosen = test.partition(":")
        if chosen:
            return chosen
        text = (self.folder / "tests" / f"{name}.cpp").read_text(encoding="utf-8")
        suites = sorted(set(re.findall(r"^TEST(_F|_P)?\((\w+),", text, re.MULTILINE)))
        return ":".join(f"*/{suite}.*" if kind == "_P" else f"{suite}.*" for kind, suite in suites)

    def copy(self):
        """Of what has changed only, so that nothing else is built again."""
        if self.folder == ROOT:
            sys.exit("--scratch: expected another folder than that of the sources")
        for folder, folders, files in os.walk(ROOT):
            folders[:] = [name for name in folders if name not in LEFT_OUT]
            for name in files:
                source = Path(folder) / name
                target = self.folder / source.relative_to(ROOT)
                if not target.exists() or target.read_bytes() != source.read_bytes():
                    target.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy(source, target)

    def make(self, tests):
        targets = sorted({self.holder(test) for test in tests})
        return subprocess.run(["ninja", "-C", str(self.build), f"-j{self.jobs}", *targets], capture_output=True,
                              text=True)

    def passes(self, test):
        command = [str(self.build / "tests" / self.holder(test)), f"--gtest_filter={self.filter(test)}"]
        began = time.monotonic()
        environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
        try:
            run = subprocess.run(command, cwd=self.build / "tests", capture_output=True, env=environment,
                                 timeout=self.longest.get(test, LONGEST))
        except subprocess.TimeoutExpired:
            return False
        if b"Running 0 tests" in run.stdout:
            sys.exit(f"{test}: names no test of {self.holder(test)}")
        self.longest.setdefault(test, 30 + SLOWER * (time.monotonic() - began))
        return run.returncode == 0

    def outcome(self, mutation):
        """'caught by TEST', 'escaped' or 'does not compile: ...'."""
        made = self.make(mutation["tests"])
        if made.returncode != 0:
            errors = [line for line in made.stdout.splitlines() if ": error:" in line]
            return f"does not compile: {errors[0] if errors else made.stdout[-300:]}"
        for test in mutation["tests"]:
            if not self.passes(test):
                return f"caught by {test}"
        return "escaped"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="REGEX", default="", help="mutations whose name or file matches")
    parser.add_argument("--check", action="store_true", help="only whether all apply")
    parser.add_argument("--scratch", metavar="DIR", type=Path, default=ROOT / "build" / "mutation")
    parser.add_argument("--jobs", metavar="N", type=int, default=os.cpu_count())
    options = parser.parse_args()

    mutations = read_mutations()
    said = faults_of(mutations)
    if said or options.check:
        print("\n".join(said) if said else f"all {len(mutations)} mutations apply")
        return 1 if said else 0
    chosen = [m for m in mutations if re.search(options.only, m["name"]) or re.search(options.only, m["file"])]
    chosen.sort(key=lambda mutation: mutation["file"])  # a file is compiled once for each, not once more between

    scratch = Scratch(options.scratch.resolve(), options.jobs)
    tests = sorted({test for mutation in chosen for test in mutation["tests"]})
    made = scratch.make(tests)
    if made.returncode != 0:
        sys.exit(made.stdout + made.stderr)
    failing = [test for test in tests if not scratch.passes(test)]
    if failing:
        sys.exit(f"without any mutation these fail: {', '.join(failing)}")

    missed = 0
    for mutation in chosen:
        began = time.monotonic()
        file = scratch.folder / mutation["file"]
        original = file.read_text(encoding="utf-8")
        file.write_text(original.replace(mutation["find"], mutation["replace"]), encoding="utf-8")
        try:
            outcome = scratch.outcome(mutation)
        finally:
            file.write_text(original, encoding="utf-8")
        missed += not outcome.startswith("caught")
        print(f"{mutation['file']}: {mutation['name']}: {outcome} ({time.monotonic() - began:.0f} s)", flush=True)
    print(f"{len(chosen)} mutations, {len(chosen) - missed} caught, {missed} not")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
