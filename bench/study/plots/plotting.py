"""What the plot scripts have in common: reading the CSV, the look of the pictures, writing them.

A CSV file has a header line and rows; lines that begin with '#' are its notes ("key: text"), of which the origin of the
numbers (processor, program, compiler) goes into the foot of the picture. The scripts draw what stands in the file and
compute nothing.
"""

import contextlib
import csv
import os
import signal
import sys
import textwrap

try:
    import matplotlib
    matplotlib.use("Agg")  # no display is needed
    import matplotlib.pyplot
except ImportError:
    sys.exit(3)  # known to bench/study/plot.cpp

matplotlib.rcParams.update({
    "font.size": 10,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#dddddd",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.frameon": False,
    "svg.fonttype": "none",     # text stays text
    "svg.hashsalt": "poinsot",  # the same numbers give the same file
    "figure.max_open_warning": 0,
})

# Told apart also by those who see few colours (Okabe and Ito); black comes last.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8C564B", "#7F7F7F", "#882255", "#000000"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "<", "*"]


def read(path):
    """The rows as dictionaries by the header's names, and the notes."""
    with open(path, encoding="utf-8", newline="") as file:
        lines = file.read().split("\n")  # a name may hold other ends of lines
    notes = [line.lstrip("# ") for line in lines if line.startswith("#")]
    return list(csv.DictReader(line for line in lines if line and not line.startswith("#"))), notes


def number(text):
    """The number in a field; None where it is empty."""
    return float(text) if text else None


def note(notes, key):
    """The text of the note "key: text"; empty where there is none."""
    return next((line[len(key) + 2:] for line in notes if line.startswith(key + ": ")), "")


def save(figure, stem, notes):
    """Writes STEM.svg and STEM.png, whole or not at all, the origin of the numbers in the foot."""
    program, compiler = note(notes, "program"), note(notes, "compiler")
    foot = [note(notes, "processor"), f"{program}; {compiler}" if compiler else program]
    characters = int(18 * figure.get_figwidth())  # that fit beside one another
    figure.text(0.01, 0.004, "\n".join(textwrap.fill(line, characters) for line in foot if line), fontsize=6.5,
                color="#555555", va="bottom")
    for extension, options in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 150})):
        partial = f"{stem}.{os.getpid()}.partial"
        try:
            figure.savefig(partial, format=extension, **options)
            os.replace(partial, f"{stem}.{extension}")
        finally:  # of a disk that is full, or a signal
            with contextlib.suppress(FileNotFoundError):
                os.unlink(partial)
    matplotlib.pyplot.close(figure)


def main(draw):
    """Calls draw(rows, notes) for every pair CSV STEM of the command line and saves the figure it returns."""
    if len(sys.argv) < 3 or len(sys.argv) % 2 == 0:
        sys.exit(f"usage: {sys.argv[0]} CSV STEM [CSV STEM ...]")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    for path, stem in zip(sys.argv[1::2], sys.argv[2::2]):
        rows, notes = read(path)
        save(draw(rows, notes), stem, notes)
