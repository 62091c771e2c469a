"""Work-precision diagram of `poinsot chart`: error against time for every method, beside it violation and drift."""

import plotting
from matplotlib import pyplot
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


def key(row):
    return row["integrator"], row["formulation"], row["linear_solver"]


def in_order(rows, name):
    return list(dict.fromkeys(row[name] for row in rows))


def method(row, solvers):
    return f"{row['integrator']} {row['formulation']}" + (f" {row['linear_solver']}" if len(solvers) > 1 else "")


def panel(axes, rows, column, title, colours, solvers, styles, resolved):
    leaders = []
    for name in dict.fromkeys(key(row) for row in rows):
        points = [row for row in rows if key(row) == name and row[column] and float(row[column]) > 0]
        if not points:
            continue
        x, y = [float(row[column]) for row in points], [1e3 * float(row["seconds"]) for row in points]
        colour, marker = colours[name[0]], FORMULATIONS.get(name[1], "D")
        axes.plot(x, y, linestyle=styles[name[2]], color=colour, marker=marker, markersize=3.5, linewidth=0.9, alpha=0.6,
                  markerfacecolor="white", markeredgewidth=0.8)
        if column in QUANTITIES:
            best = [row for row in points if row[f"front_{column}"] == "1"]
            axes.plot([float(row[column]) for row in best], [1e3 * float(row["seconds"]) for row in best], ls="",
                      color=colour, marker=marker, markersize=6.5, zorder=5)
            leaders += [(float(row["seconds"]), method(row, solvers)) for row in best]
    if not axes.lines:
        axes.set_axis_off()
        axes.text(0.5, 0.5, f"no {title}:\n{NONE[column]}", ha="center", va="center", fontsize=9,
                  color="#555555", transform=axes.transAxes)
        return
    axes.set(xscale="log", yscale="log", xlabel=title, ylabel="time, ms")
    if resolved:
        axes.axvline(resolved, color="#555555", linewidth=0.9, linestyle="--", gid=f"resolved_{column}")
    axes.invert_xaxis()
    if column in QUANTITIES and axes.get_xlim()[0] > 3:
        axes.set_xlim(left=3)  # what is wrong altogether needs no room
    if column in QUANTITIES:
        names = list(dict.fromkeys(name for _, name in sorted(leaders)))
        lines = [", ".join(names[k:k + 3]) for k in range(0, len(names), 3)]
        axes.set_title("front: " + (",\n".join(lines) if lines else "none"), fontsize=8, loc="left")


def draw(rows, notes):
    resolved = next((row for row in rows if row["status"] == "reference"), {})
    rows = [row for row in rows if row["status"] != "reference"]
    # Those that failed count, too: a method has the same colour in the charts of all scenes.
    colours = dict(zip(in_order(rows, "integrator"), plotting.COLOURS * 3))
    styles = dict(zip(in_order(rows, "linear_solver"), STYLES * 2))
    rows = [row for row in rows if row["status"] == "ok"]
    drawn, solvers = in_order(rows, "integrator"), in_order(rows, "linear_solver")
    figure, axes = pyplot.subplots(2, 3, figsize=(15, 9.6))
    for axis, (column, title) in zip(axes.flat, PANELS):
        panel(axis, rows, column, title, colours, solvers, styles, plotting.number(resolved.get(column, "")))

    leading = {row["integrator"] for row in rows if any(row[f"front_{q}"] == "1" for q in QUANTITIES)}
    entries = [Line2D([], [], color=colours[name], linewidth=2.5, label=name + (" (front)" if name in leading else ""))
               for name in colours if name in drawn]
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
    figure.tight_layout(rect=(0, 0.13, 1, 0.99))
    return figure


plotting.main(draw)
