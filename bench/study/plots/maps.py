"""Maps of verdicts, from the CSV of bench/stability/maps.h: a panel for each formulation and integrator, a field for each
place along x and y, which are as far apart as there are places and not by their numbers."""

from plotting import main, matplotlib, note

SIDE, GAP = 1.55, 0.28  # inches of a panel, and between two
LEAST, FOOT, LINE = 8.5, 0.45, 0.19  # inches: width, below the legend, of a line of it
# A colour and a sign: told apart by those who see few colours, and on paper.
LOOKS = {
    "accurate": ("#0072B2", "", "accurate: as order and tolerance promise"),
    "coarse": ("#9CCBE8", "", "coarse: the order promises no better"),
    "told": ("#F0E442", "!", "wrong, but the run says so"),
    "stop": ("#C8C8C8", "", "stopped, with a status:"),
    "wrong": ("#D55E00", "×", "silently wrong"),
}
STATUS = {"not_converged": "n", "singular_matrix": "m", "not_finite": "f",
          "inconsistent_state": "c", "constraint_lost": "l", "singular_position": "p", "rotation_too_large": "r",
          "step_size_too_small": "s", "refused": "d", "input_error": "i"}
INK = {"told": "#000000", "stop": "#333333", "wrong": "#000000"}


def names(rows, column):
    """The values in a column, each once, in the order of the rows."""
    return list(dict.fromkeys(row[column] for row in rows))


def ticks(values):
    """Places of the labels, and the labels: some five of them."""
    every = max(1, -(-len(values) // 6))
    places = list(range(0, len(values), every))
    return places, [values[k] for k in places]


def ordered(values):
    return sorted(values, key=float)


def draw_panel(axes, rows):
    xs, ys = ordered(names(rows, "x")), ordered(names(rows, "y"))
    for row in rows:
        x, y = xs.index(row["x"]), ys.index(row["y"])
        colour, sign, _ = LOOKS[row["verdict"]]
        axes.add_patch(matplotlib.patches.Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=colour, edgecolor="white",
                                                    linewidth=0.4))
        if row["verdict"] == "stop":
            sign = STATUS.get(row["status"], "?")
        if sign:
            axes.text(x, y, sign, ha="center", va="center", fontsize=7, color=INK[row["verdict"]])
    axes.set_xlim(-0.5, len(xs) - 0.5)
    axes.set_ylim(-0.5, len(ys) - 0.5)
    axes.grid(False)
    axes.set_xticks(*ticks(xs)[:1])
    axes.set_yticks(*ticks(ys)[:1])
    axes.set_xticklabels(ticks(xs)[1], fontsize=5.5, rotation=60)
    axes.set_yticklabels(ticks(ys)[1], fontsize=5.5)
    axes.tick_params(length=2, pad=1)


def draw(rows, notes):
    formulations, integrators = names(rows, "formulation"), names(rows, "integrator")
    across, down = len(integrators), len(formulations)
    of_panels = across * (SIDE + GAP) + 1.2
    width = max(of_panels, LEAST)  # the legend's words need as much
    beside = min(len(LOOKS), max(2, int(width / 3)))
    legend = FOOT + LINE * -(-len(LOOKS) // beside)  # its upper end
    height = down * (SIDE + GAP) + 1.2 + legend
    figure, axes = matplotlib.pyplot.subplots(down, across, figsize=(width, height), squeeze=False)
    for line, formulation in enumerate(formulations):
        for column, integrator in enumerate(integrators):
            axis = axes[line][column]
            own = [row for row in rows if row["formulation"] == formulation and row["integrator"] == integrator]
            if line == 0:
                axis.set_title(integrator, fontsize=9)
            if column == 0:
                axis.set_ylabel(formulation, fontsize=10, fontweight="bold")
            if own:
                draw_panel(axis, own)
            else:
                axis.set_xticks([])
                axis.set_yticks([])
                axis.grid(False)
                axis.text(0.5, 0.5, "refused", ha="center", va="center", fontsize=8, color="#777777",
                          transform=axis.transAxes)
    stops = [f"{STATUS.get(status, '?')} {status}" for status in names(rows, "status") if status != "ok"]
    patches = [matplotlib.patches.Patch(facecolor=colour, edgecolor="#777777",
                                        label=f"{text} {', '.join(stops) or 'none'}" if text.endswith(":")
                                        else f"{text} {sign}".strip()) for colour, sign, text in LOOKS.values()]
    figure.suptitle(note(notes, "title"), fontsize=12)
    margin = (1 - of_panels / width) / 2
    figure.tight_layout(rect=(margin + 0.02, (legend + 0.35) / height, 1 - margin, 1 - 0.15 / height))
    figure.text(0.5, (legend + 0.1) / height, f"across: {note(notes, 'x')}; upwards: {note(notes, 'y')}", ha="center",
                fontsize=9.5)
    figure.legend(handles=patches, loc="lower center", ncol=beside, fontsize=8.5, borderpad=0, labelspacing=0.3,
                  bbox_to_anchor=(0.5, FOOT / height))
    return figure


if __name__ == "__main__":
    main(draw)
