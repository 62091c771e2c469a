"""Work-precision diagram of `poinsot chart`: time against error for every method, beside it violation and drift.

Above a panel stands what follows from it, a note of the CSV. The methods it names are drawn in colour and labelled at
their accurate ends; all others are grey.
"""

import re
import textwrap

import plotting
from matplotlib import pyplot, ticker
from matplotlib.lines import Line2D

QUANTITIES = ["position", "velocity", "acceleration", "multiplier"]
PANELS = [("position", "error in position"), ("velocity", "error in velocity"),
          ("violation_position", "violation of the constraints, position"),
          ("acceleration", "error in acceleration"), ("multiplier", "error in multipliers"),
          ("energy_drift", "energy drift, of the largest kinetic energy")]
STYLES = ["-", "--", ":", "-.", (0, (5, 1, 1, 1, 1, 1)), (0, (8, 3)), (0, (1, 3)), (0, (3, 1))]  # linear solvers
NONE = {column: "every one is 0 or nothing was computed" for column, _ in PANELS}
NONE["multiplier"] = "the scene has no constraints"
NONE["energy_drift"] = "the scene's energy changes"
FORMULATIONS = {"rA": "o", "rp": "s", "reps": "^"}
GREY = "#b5b5b5"
ROUNDING = 1e-12  # of positions in metres and of energies relative: nothing but rounding is below


def key(row):
    return row["integrator"], row["formulation"], row["linear_solver"]


def in_order(rows, name):
    return list(dict.fromkeys(row[name] for row in rows))


def named(name, solvers, conclusion):
    """Whether a method is spoken of in a conclusion."""
    method = f"{name[0]} in {name[1]}"
    own = [re.escape(method) + r"(?! with)\b", re.escape(f"{method} with {name[2]}") + r"\b"]
    return any(re.search(r"(?<!\w)" + one, conclusion) for one in (own if len(solvers) < 2 else own[-1:] + own[:1]))


def say(axes, text):
    axes.set_axis_off()
    axes.text(0.5, 0.5, textwrap.fill(text, 48), ha="center", va="center", fontsize=9, color="#555555",
              transform=axes.transAxes)


def label_ends(axes, ends):
    """Names beside the accurate ends of their curves, moved up and down until none covers another."""
    low, high = axes.get_ylim()
    place = lambda y: axes.transAxes.inverted().transform(axes.transData.transform((1, y)))[1]
    ends = sorted(ends, key=lambda end: end[1])
    free = 0.02
    for x, y, text, colour in ends:
        height = max(place(y), free)
        free = height + 0.052
        axes.annotate(text, (x, y), (0.985, min(height, 0.97)), textcoords="axes fraction", fontsize=7.5, color=colour,
                      ha="right", va="center", arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.5,
                                                           "alpha": 0.6})
    axes.set_ylim(low, high)


def panel(axes, rows, column, title, colours, solvers, styles, resolved, conclusion):
    drawn = [row for row in rows if row[column] and float(row[column]) > 0]
    if not drawn:
        say(axes, f"no {title}: {NONE[column]}")
        return
    if conclusion.startswith("every case is as accurate"):
        say(axes, f"{title}: {conclusion}")
        return
    if column not in QUANTITIES and all(float(row[column]) < ROUNDING for row in drawn):
        say(axes, f"{title}: below {ROUNDING:g} in every case, which is rounding")
        return
    axes.set(xscale="log", yscale="log", xlabel=f"{title}    (more accurate →)", ylabel="time, ms")
    ends = []
    for name in dict.fromkeys(key(row) for row in rows):
        points = [row for row in drawn if key(row) == name]
        if not points:
            continue
        x, y = [float(row[column]) for row in points], [1e3 * float(row["seconds"]) for row in points]
        first = column in QUANTITIES and named(name, solvers, conclusion)
        colour, marker = colours[name[0]] if first or column not in QUANTITIES else GREY, FORMULATIONS.get(name[1], "D")
        axes.plot(x, y, linestyle=styles[name[2]], color=colour, marker=marker, markersize=3.5,
                  linewidth=1.2 if first else 0.7, alpha=0.9 if first else 0.55, zorder=3 if first else 2,
                  markerfacecolor="white", markeredgewidth=0.8)
        if first:
            best = [row for row in points if row[f"front_{column}"] == "1"]
            axes.plot([float(row[column]) for row in best], [1e3 * float(row["seconds"]) for row in best], ls="",
                      color=colour, marker=marker, markersize=6.5, zorder=5)
            end = min(range(len(x)), key=lambda k: x[k])
            ends.append((x[end], y[end], f"{name[0]} {name[1]}" + (f" {name[2]}" if len(solvers) > 1 else ""), colour))
    if resolved:
        axes.axvline(resolved, color="#555555", linewidth=0.9, linestyle="--", gid=f"resolved_{column}")
    axes.invert_xaxis()
    if column in QUANTITIES and axes.get_xlim()[0] > 3:
        axes.set_xlim(left=3)  # what is wrong altogether needs no room
    low, high = axes.get_ylim()
    if high / low < 30:  # at least a decade around, so that two ticks have labels
        axes.set_ylim(low / 2, high * 2)
    axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5) if high / low < 100 else (1,), numticks=9))
    axes.yaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(ticker.NullFormatter())
    if ends:
        left, right = axes.get_xlim()
        axes.set_xlim(left, right * (right / left) ** 0.38)  # room for the names
        label_ends(axes, ends)
    if conclusion:
        axes.set_title(textwrap.fill(conclusion, 74), fontsize=7.5, loc="left")


def draw(rows, notes):
    resolved = next((row for row in rows if row["status"] == "reference"), {})
    rows = [row for row in rows if row["status"] != "reference"]
    # Those that failed count, too: a method has the same colour in the charts of all scenes.
    colours = dict(zip(in_order(rows, "integrator"), plotting.COLOURS * 3))
    styles = dict(zip(in_order(rows, "linear_solver"), STYLES * 2))
    rows = [row for row in rows if row["status"] == "ok"]
    drawn, solvers = in_order(rows, "integrator"), in_order(rows, "linear_solver")
    figure, axes = pyplot.subplots(2, 3, figsize=(16.5, 11))
    for axis, (column, title) in zip(axes.flat, PANELS):
        panel(axis, rows, column, title, colours, solvers, styles, plotting.number(resolved.get(column, "")),
              plotting.note(notes, f"conclusion, {column}"))

    entries = [Line2D([], [], color=colours[name], linewidth=2.5, label=name) for name in colours if name in drawn]
    entries += [Line2D([], [], color=GREY, linewidth=2.5, label="not among the fastest two")]
    entries += [Line2D([], [], color="#333333", ls="", marker=FORMULATIONS.get(name, "D"), markerfacecolor="white",
                       label=name) for name in in_order(rows, "formulation")]
    entries += [Line2D([], [], color="#333333", linestyle=styles[name], label=name)
                for name in solvers if len(solvers) > 1]
    entries += [Line2D([], [], color="#333333", ls="", marker="o", markersize=6.5, label="on the front"),
                Line2D([], [], color="#555555", linestyle="--", label="resolved by the reference")]
    figure.legend(handles=entries, loc="lower center", bbox_to_anchor=(0.5, 0.035), ncols=7, fontsize=9)
    name = plotting.note(notes, "scene").rsplit(", content", 1)[0]
    figure.suptitle(f"{name}: time against accuracy, {plotting.note(notes, 'settings').split(';')[0]}", fontsize=13,
                    parse_math=False)
    figure.tight_layout(rect=(0, 0.12, 1, 0.99), h_pad=2)
    return figure


plotting.main(draw)
