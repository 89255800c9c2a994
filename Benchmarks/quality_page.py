# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Documentation/Quality.md from what Benchmarks/measure-quality measured."""
import math
import statistics

# What is required of the meshes of the two atlases; the program measures all of it.
CGAL_NON_MANIFOLD_ON_KNEE = 457
COLUMNS = (("default", "Voxplex"), ("optimised", "optimised"), ("cgal", "CGAL"), ("cgal-optimised", "perturb + exude"))


def median(runs, value):
    return statistics.median(value(run) for run in runs)


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "| --- |" + " ---: |" * (len(header) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def number(value, decimals=2):
    return "-" if value is None else f"{value:,.{decimals}f}"


def count(value):
    return f"{value:,}"


class Atlas:
    """What was measured of one image; answers with the figures that the page shows."""

    def __init__(self, data):
        self.title = data["title"]
        self.delta = data["delta"]
        self.figures = data["figures"]
        self.runs = data["runs"]
        self.pairs = data["pairs"]

    def seconds(self, column):
        """Single-threaded, median of the runs: of making the mesh, and of optimising it."""
        if column in ("default", "optimised"):
            runs = self.runs[column]
            optimisation = median(runs, lambda run: run["time"]["optimisation"])
            return median(runs, lambda run: run["time"]["total_without_io"]) - optimisation, optimisation
        refinement = median(self.runs["cgal"], lambda run: run["refinement_seconds"])
        if column == "cgal":
            return refinement, 0.0
        return refinement, median(self.runs["cgal"], lambda run: run["perturb_seconds"] + run["exude_seconds"])

    def rows(self):
        """Name of the figure, and how to print it for one mesh."""
        return [
            ("tetrahedra", lambda f: count(f["elements"])),
            ("labels, components of 8 voxels and more lost", lambda f: "{} of {}, {} of {}".format(
                len(f["image"]["lost_labels"]), self.labels(), len(f["image"]["lost_components"]), f["image"]["components"])),
            ("Hausdorff distance to the faces of voxels, mm", lambda f: number(f["hausdorff"]["voxels"]["distance"])),
            ("- from the image: largest, 99 %, mean", lambda f: _three(f["hausdorff"]["voxels"]["image_to_mesh"])),
            ("volumes of labels, error, %", lambda f: number(100 * f["image"]["label_volume_error"])),
            ("radius-edge ratio, largest", lambda f: number(f["quality"]["max_radius_edge"], 4)),
            ("dihedral angles, degrees", lambda f: _range(f["quality"])),
            ("facet angle off and at junctions, smallest", lambda f: "{}, {}".format(
                number(f["quality"]["min_planar_off_junctions"]), number(f["quality"]["min_planar_at_junctions"]))),
            ("facets with an angle below 30 degrees, off and at junctions", lambda f: "{} + {}".format(
                count(off_junctions(f["quality"])), count(f["quality"]["facet_angle_violations_at_junctions"]))),
            ("non-manifold edges (by label), off and at junctions", lambda f: "{} + {}".format(
                count(non_manifold_off_junctions(f)), count(f["topology"]["non_manifold_edges_at_junctions"]))),
        ]

    def labels(self):
        first = next(iter(self.figures.values()))
        return sum(1 for label in first["labels"].values() if label["voxels"] > 0)

    def measured(self):
        columns = [(key, name) for key, name in COLUMNS if key in self.figures]
        rows = [[name] + [show(self.figures[key]) for key, _ in columns] for name, show in self.rows()]
        rows.append(["made and optimised in, s"] +
                    [" + ".join(map(number, self.seconds(key)[:2 if "optimised" in key else 1])) for key, _ in columns])
        return table([""] + [name for _, name in columns], rows)

    def criteria(self):
        """What is asked; what was measured of both meshes, each with whether it is met."""
        figures = [self.figures[key] for key in ("default", "optimised")]

        def row(text, show, met):
            return (text, *((show(f), met(f)) for f in figures))
        result = [
            row("labels, components of 8 voxels and more lost: none",
                lambda f: f"{len(f['image']['lost_labels'])}, {len(f['image']['lost_components'])}",
                lambda f: not f["image"]["lost_labels"] and not f["image"]["lost_components"]),
            row("symmetric Hausdorff distance over delta: at most 1.5",
                lambda f: number(f["hausdorff"]["voxels"]["distance"] / self.delta),
                lambda f: f["hausdorff"]["voxels"]["distance"] / self.delta <= 1.5),
            row("facet angles off junctions: 30 degrees or more",
                lambda f: number(f["quality"]["min_planar_off_junctions"]), lambda f: off_junctions(f["quality"]) == 0),
            row("facet angles at junctions: 20 degrees or more",
                lambda f: number(f["quality"]["min_planar_at_junctions"]),
                lambda f: f["quality"]["small_facet_angles_at_junctions"] == 0),
            row("non-manifold edges off junctions: none",
                lambda f: count(non_manifold_off_junctions(f)), lambda f: non_manifold_off_junctions(f) == 0)]
        if self.title.startswith("Knee"):
            result.append(row(f"non-manifold edges: fewer than half of CGAL's {CGAL_NON_MANIFOLD_ON_KNEE}",
                              lambda f: count(f["topology"]["non_manifold_edges"]),
                              lambda f: 2 * f["topology"]["non_manifold_edges"] < CGAL_NON_MANIFOLD_ON_KNEE))
        before, after = (f["quality"] for f in figures)
        result.append(("radius-edge ratio: below 2; optimised at most 2.5",
                       (number(before["max_radius_edge"], 4), before["max_radius_edge"] < 2),
                       (number(after["max_radius_edge"], 4), after["max_radius_edge"] <= 2.5)))
        result.append(("dihedral angles: 4.6 to 171 degrees; optimised 18 to 150",
                       (_range(before), before["min_dihedral"] >= 4.6 and before["max_dihedral"] <= 171),
                       (_range(after), after["min_dihedral"] >= 18 and after["max_dihedral"] <= 150)))
        if "cgal-optimised" in self.figures:
            ours, theirs = self.seconds("optimised")[1], self.seconds("cgal-optimised")[1]
            result.append(("optimisation: less time than perturb + exude", None,
                           (f"{ours:.2f} s against {theirs:.2f} s", ours < theirs)))
        for name, seconds in self.rates():
            plain = median(self.pairs, lambda pair: self.plain_rate(pair, seconds))
            full = median(self.pairs, lambda pair: pair["full"]["elements"] / seconds(pair["full"]))
            ratio = median(self.pairs, lambda pair: pair["full"]["elements"] / seconds(pair["full"]) /
                           self.plain_rate(pair, seconds))
            result.append((f"{name}: at least 70 % of plain refinement's",
                           (f"{100 * ratio:.0f} % ({full:,.0f} of {plain:,.0f})", ratio >= 0.7), None))
        return result

    @staticmethod
    def plain_rate(pair, seconds):
        """Tetrahedra a second of plain refinement before and after."""
        return 2 * pair["before"]["elements"] / (seconds(pair["before"]) + seconds(pair["after"]))

    @staticmethod
    def rates():
        def refinement(run):
            return run["time"]["refinement"] + run["time"]["components"]

        def total(run):
            return run["time"]["total_without_io"] - run["time"]["optimisation"]
        return [("tetrahedra a second, components and refinement", refinement),
                ("tetrahedra a second, all but optimisation", total)]

    def asked(self):
        def cell(answer):
            return "" if answer is None else answer[0] if answer[1] else f"**{answer[0]}: missed**"
        # What is asked of both meshes is among the figures: of these criteria the page has those that are missed.
        shown = [(text, *answers) for text, *answers in self.criteria()
                 if not all(answer is not None and answer[1] for answer in answers)]
        return table(["asked", "Voxplex", "optimised"], [[text, *map(cell, answers)] for text, *answers in shown])


def off_junctions(quality):
    return quality["facet_angle_violations"] - quality["facet_angle_violations_at_junctions"]


def non_manifold_off_junctions(figures):
    return figures["topology"]["non_manifold_edges"] - figures["topology"]["non_manifold_edges_at_junctions"]


def _three(figures):
    return f"{figures['max']:.2f}, {figures['p99']:.2f}, {figures['mean']:.3f}"


def _range(quality):
    return f"{quality['min_dihedral']:.2f} to {quality['max_dihedral']:.2f}"


def grading_section(grading):
    """None if the program cannot grade; else by input a list of runs of both modes."""
    if grading is None:
        return "Not measured in this run.\n"
    parts = ["The Hausdorff distance of each graded mesh to the smooth interface, and the number of tetrahedra that a uniform mesh has at\n"
             "this distance, interpolated between several uniform meshes. If the graded mesh is nearer than all of them, the saving is at\n"
             "least the figure given.\n"]
    rows = []
    for name, series in grading.items():
        uniform = sorted((run["distance"], run["elements"]) for run in series["uniform"])
        for run in series["lfs"]:
            beyond = run["distance"] < uniform[0][0]
            equal = uniform[0][1] if beyond else _at_distance(uniform, run["distance"])
            more = "> " if beyond else ""
            rows.append([name, number(run["delta"]), number(run["ratio"]), count(run["elements"]),
                         number(run["distance"], 3), more + count(round(equal)) if equal else "beyond the series",
                         more + f"{100 * (1 - run['elements'] / equal):.0f} %" if equal else "-"])
    parts.append(table(["input", "delta", "ratio", "graded: tetrahedra", "distance, mm", "uniform: tetrahedra", "saved"],
                       rows))
    return "\n".join(parts)


def _at_distance(series, distance):
    """Elements of a uniform mesh at this distance; None outside of the series."""
    for (low, more), (high, fewer) in zip(series, series[1:]):
        if low <= distance <= high and high > low:
            weight = _log_ratio(distance, low) / _log_ratio(high, low)
            return more * (fewer / more) ** weight
    return None


def _log_ratio(a, b):
    return math.log(a / b)


INTRODUCTION = """\
# Quality of the meshes

`Benchmarks/measure-quality` makes this page; `build/quality/log.txt` has its commands. Figures are those of
`voxplex.quality()` ([Reference.md](Reference.md#quality)). All runs have one thread. Times are medians of {repeat} runs, and
rates of {pairs} pairs of runs, which took turns. Compare them only with each other. Machine: {machine}.

- **Voxplex** is `voxplex` without optimisation, **optimised** with it; other options have their defaults.
- **CGAL** is `make_mesh_3` of CGAL 5.5 with facet angle 30 degrees, radius-edge ratio 2, a size tuned to as many
  tetrahedra, and no perturbation and exudation. **perturb + exude** is the same mesh after both, without limit of time.
- Distances are to the faces between voxels of different labels. A non-manifold edge counts once for each label.

These things are asked of every mesh. They are met, unless a table says *missed*:

| asked | without optimisation | optimised |
| --- | ---: | ---: |
| labels, and components of 8 voxels or more, that are lost | 0 | 0 |
| Hausdorff distance, at most | 1.5 delta | 1.5 delta |
| facet angles off junctions, and at them, at least | 30, 20 degrees | 30, 20 degrees |
| non-manifold edges off junctions | 0 | 0 |
| radius-edge ratio, below | 2 | 2.5 |
| dihedral angles, degrees | 4.6 to 171 | 18 to 150 |
"""


def make_page(results):
    parts = [INTRODUCTION.format(repeat=results["repeat"], machine=results["machine"],
                                  pairs=len(next(iter(results["atlases"].values()))["pairs"]))]
    for key, data in results["atlases"].items():
        atlas = Atlas(data)
        parts += [f"## {atlas.title}\n", atlas.measured(), atlas.asked(),
                  f"![Dihedral angles](Images/quality-{key}-dihedral.png)\n",
                  f"![Radius-edge ratios and facet angles](Images/quality-{key}-shapes.png)\n"]
    for name in results["missing"]:
        parts.append(f"{name}\n")
    parts += ["## Grading at equal distance\n", grading_section(results["grading"])]
    return "\n".join(parts)
