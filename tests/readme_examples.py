"""Runs the examples of README.md and of the pages beside models and program: readme_examples.py SOURCE
PROGRAM_DIRECTORY.

A block marked `sh` is run as it stands by a shell that stops at the first failure, in one temporary directory for all
blocks, with the program on the PATH and the models where the README says. A block marked `bash` takes long and has its
own place in the tests; of it, that the scripts and presets it names exist. A block marked `cmake` or `cpp` must stand
in the example project, which is built and run by a test of its own. And every option of `poinsot run` is spoken of.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

source = pathlib.Path(sys.argv[1]).resolve()
environment = dict(os.environ, PATH=os.path.abspath(sys.argv[2]) + os.pathsep + os.environ["PATH"])
text = "\n".join((source / page).read_text(encoding="utf-8") for page in ("README.md", "models/README.md", "app/README.md"))
blocks = re.findall(r"^```(\w+)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
presets = {preset["name"] for preset in json.loads((source / "CMakePresets.json").read_text())["configurePresets"]}
example = "".join(file.read_text() for file in sorted((source / "tests/example_project").iterdir()))
problems = []


def timeless(printed):
    """Without the lines that say how long a step took, and what is rounding."""
    return [line for line in printed.splitlines() if "us a step" not in line and "largest violation" not in line]


# A program that was built without npm has no page to write.
no_page = "without the page" in subprocess.run(["poinsot", "view", "-", "--out", "-"], env=environment, capture_output=True,
                                               stdin=subprocess.DEVNULL, text=True).stderr
if no_page:
    print("examples of `poinsot view` are left out: the program was built without the page")

with tempfile.TemporaryDirectory() as directory:
    os.symlink(source / "models", pathlib.Path(directory) / "models")
    environment["XDG_CACHE_HOME"] = directory
    for number, (language, block) in enumerate(blocks):
        if language == "sh":
            if no_page:
                block = re.sub(r"^poinsot view .*$", "", block, flags=re.MULTILINE)
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", block], cwd=directory, env=environment,
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True)
            if done.returncode != 0:
                problems.append(f"exit status {done.returncode}:\n{block}{done.stdout}{done.stderr}")
            shown = blocks[number + 1] if number + 1 < len(blocks) else ("", "")
            if shown[0] == "text" and f"{block}```\n\n```text\n" in text and timeless(done.stdout) != timeless(shown[1]):
                problems.append(f"prints something else:\n{block}{done.stdout}")
        elif language == "bash":
            problems += [f"no script {script}" for script in re.findall(r"^bash (\S+)", block, re.MULTILINE)
                         if not (source / script).is_file()]
            problems += [f"no preset {preset}" for preset in re.findall(r"--preset (\w+)", block)
                         if preset not in presets]
        elif language in ("cmake", "cpp"):
            if block not in example:
                problems.append(f"not in tests/example_project:\n{block}")
        elif language != "text":
            problems.append(f"a block marked {language}: nothing exercises it")

options = subprocess.run(["poinsot", "run", "--help"], env=environment, capture_output=True, text=True, check=True)
for option in set(re.findall(r"--([a-z-]+)", options.stdout)) - {"help"}:
    if f"`--{option}" not in text and f"`{option.replace('-', '_')}`" not in text:
        problems.append(f"nothing about --{option}")

ran = [language for language, _ in blocks].count("sh")
if ran == 0 or text.count("\n```") != 2 * len(blocks):
    problems.append("no example was found to run, or a block is not marked")
print(f"{ran} examples run", *problems, sep="\n")
sys.exit(1 if problems else 0)
