# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Histograms of several meshes as pictures, for Benchmarks/measure-quality. Needs python3-matplotlib."""
import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402 (the backend must be chosen first)

ANGLE_WIDTH = 2.0
RATIO_WIDTH = 0.05

# Of Okabe and Ito's palette, which those with colour-blindness can tell apart.
STYLES = {
    "default": ("Voxplex", "#0072b2", "-"),
    "optimised": ("Voxplex, optimised", "#d55e00", "-"),
    "cgal": ("CGAL", "#999999", "--"),
    "cgal-optimised": ("CGAL, perturb + exude", "#000000", "--"),
}


def _draw(axes, meshes, key, width, title, logarithmic):
    """Each histogram as a line of steps: percent of all by bin; bins beyond the last that any mesh uses are left out."""
    used = 0
    for name, (label, colour, dashes) in STYLES.items():
        if name not in meshes:
            continue
        counts = meshes[name]["quality"][key]
        total = sum(counts)
        used = max([used] + [i + 1 for i, count in enumerate(counts) if count])
        edges = [width * i for i in range(len(counts) + 1)]
        shares = [100.0 * count / total if count or not logarithmic else float("nan") for count in counts]
        axes.stairs(shares, edges, label=label, color=colour, linestyle=dashes, linewidth=1.3)
    axes.set_xlim(0, width * used)
    axes.set_title(title, fontsize=10)
    axes.grid(True, linewidth=0.4, alpha=0.6)
    axes.tick_params(labelsize=8)
    if logarithmic:
        axes.set_yscale("log")
    else:
        axes.set_ylim(bottom=0)


def _save(figure, path):
    figure.tight_layout()
    figure.savefig(path, dpi=110, metadata={"Software": None})
    pyplot.close(figure)


def draw_dihedral_angles(meshes, title, path):
    """All dihedral angles of each mesh, in a linear and in a logarithmic scale, which shows the tails."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 3.6))
    _draw(left, meshes, "dihedral_histogram", ANGLE_WIDTH, f"{title}: dihedral angles", False)
    _draw(right, meshes, "dihedral_histogram", ANGLE_WIDTH, "the same, logarithmic", True)
    left.set_ylabel("% of all angles, by 2 degrees", fontsize=8)
    for axes in (left, right):
        axes.set_xlabel("degrees", fontsize=8)
        axes.set_xlim(0, 180)
        axes.set_xticks(range(0, 181, 20))
    left.legend(fontsize=8)
    _save(figure, path)


def draw_other_shapes(meshes, title, path):
    """Radius-edge ratios, and planar angles of interface facets."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(10, 3.6))
    _draw(left, meshes, "radius_edge_histogram", RATIO_WIDTH, f"{title}: radius-edge ratios", False)
    _draw(right, meshes, "planar_histogram", ANGLE_WIDTH, "angles of interface facets", False)
    left.set_ylabel("% of all tetrahedra, by 0.05", fontsize=8)
    left.set_xlabel("circumradius / shortest edge", fontsize=8)
    right.set_ylabel("% of all angles, by 2 degrees", fontsize=8)
    right.set_xlabel("degrees", fontsize=8)
    left.legend(fontsize=8)
    _save(figure, path)
