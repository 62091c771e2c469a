"""Curves in panels, from the CSV of bench/study/panels.h: a panel for each name in the column "panel".

Colours are the series, markers the variants; points that belong to no fit are hollow where others of the curve do;
"guide" curves are grey lines to compare slopes with; bands go from low to high.
"""

import math

from plotting import COLOURS, MARKERS, main, matplotlib, note, number

WIDTH, HEIGHT = 4.2, 3.1  # inches of a panel


def names(rows, column):
    """The names in a column, each once, in the order of the rows."""
    return list(dict.fromkeys(row[column] for row in rows))


def place_of_name(own, others, logarithms):
    """Number of the point of a guide at which its name stands: where it is farthest from the others, or in the middle."""
    size = (lambda y: math.log(y) if y > 0 else -math.inf) if logarithms else float
    def nearest(k):
        return min((abs(size(own[k]) - size(other[k])) for other in others if k < len(other)), default=0)
    middle = len(own) // 2
    return max(range(len(own)), key=lambda k: (round(nearest(k), 9), -abs(k - middle)))


def draw_panel(axes, rows, colours, markers, joined):
    guides = {}
    for row in rows:
        if row["variant"] == "guide":
            guides.setdefault(row["series"], []).append(number(row["y"]))
    for series, variant in dict.fromkeys((row["series"], row["variant"]) for row in rows):
        points = [row for row in rows if row["series"] == series and row["variant"] == variant]
        x = [number(row["x"]) for row in points]
        y = [number(row["y"]) for row in points]
        if variant == "guide":
            axes.plot(x, y, color="#555555", linestyle="--", linewidth=1, zorder=1)
            at = place_of_name(y, [other for name, other in guides.items() if name != series],
                               axes.get_yscale() == "log")
            axes.annotate(series, (x[at], y[at]), (5, -4), textcoords="offset points", fontsize=8, color="#555555", va="top")
            continue
        colour = colours[series]
        if points[0]["low"]:
            axes.fill_between(x, [number(row["low"]) for row in points], [number(row["high"]) for row in points],
                              color=colour, alpha=0.3, linewidth=0)
        if not joined:
            axes.scatter(x, y, s=9, color=colour, alpha=0.7, linewidths=0)
            continue
        if len(points) > 50:  # a course, not measurements at places of their own
            axes.plot(x, y, color=colour, linewidth=1.1)
            continue
        fitted = [row["in_fit"] == "1" for row in points]
        fill = [colour if inside or not any(fitted) else "white" for inside in fitted]
        axes.plot(x, y, color=colour, linewidth=0.9, alpha=0.7)
        marker, size = markers[variant]
        axes.scatter(x, y, s=size, marker=marker, facecolors=fill, edgecolors=colour, linewidths=0.9, zorder=3)


def handles(series, colours, variants, markers):
    """Of the legend: a line for a series, a marker for a variant, one for both where they are the same."""
    line = matplotlib.lines.Line2D
    if series == variants:
        return [line([], [], color=colours[name], marker=markers[name][0], label=name) for name in series]
    return [line([], [], color=colours[name], label=name) for name in series] + [
        line([], [], color="#555555", linestyle="", marker=markers[name][0], label=name) for name in variants if name]


def draw(rows, notes):
    panels = names(rows, "panel")
    columns = min(int(note(notes, "columns")), len(panels))
    lines = math.ceil(len(panels) / columns)
    measured = [row for row in rows if row["variant"] != "guide"]
    series = {panel: names([row for row in measured if row["panel"] == panel], "series") for panel in panels}
    colours = {name: COLOURS[k % len(COLOURS)] for k, name in enumerate(names(measured, "series"))}
    # Coinciding curves stay visible: later markers are smaller.
    markers = {name: (MARKERS[k % len(MARKERS)], 40 / (1 + k)) for k, name in enumerate(names(measured, "variant"))}
    width, height = (8 if columns == 1 else WIDTH * columns) + 0.4, HEIGHT * lines + 1.1
    figure, axes = matplotlib.pyplot.subplots(lines, columns, figsize=(width, height), squeeze=False,
                                              sharey="row" if note(notes, "shared") == "yes" else False)
    common = len(markers) > 1 or all(len(of) > 1 and set(of) & set(series[panels[0]]) for of in series.values())
    items = handles(names(measured, "series"), colours, names(measured, "variant"), markers)
    beside = min(len(items), int(0.75 * width))  # entries of the legend that fit beside one another
    legend = 0.7 + 0.2 * (math.ceil(len(items) / beside) - 1)  # inches
    for k, axis in enumerate(axes.flat):
        if k >= len(panels):
            axis.axis("off")
            continue
        axis.set_xscale(note(notes, "x scale"))
        axis.set_yscale(note(notes, "y scale"))
        axis.set_title(panels[k], fontsize=10)
        draw_panel(axis, [row for row in rows if row["panel"] == panels[k]], colours, markers,
                   note(notes, "joined") != "no")
        if k >= len(panels) - columns:
            axis.set_xlabel(note(notes, "x"))
        if k % columns == 0:
            axis.set_ylabel(note(notes, "y"))
        if not common:
            axis.legend(handles=handles(series[panels[k]], colours, [], {}), fontsize=8, ncol=3, loc="best")
    figure.suptitle(note(notes, "title"), fontsize=12)
    figure.tight_layout(rect=(0, (legend if common else 0.35) / height, 1, 1 - 0.1 / height))
    if common:
        figure.legend(handles=items, loc="lower center", ncol=beside, fontsize=9,
                      bbox_to_anchor=(0.5, 0.33 / height))
    return figure


if __name__ == "__main__":
    main(draw)
