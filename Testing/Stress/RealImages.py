#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes label images of patients and atlases with the program voxplex, and checks every mesh.

The images are those of Debian's package mricron-data and the two atlases of ../shared/data; those that are not there
are left out, with a message. Each is meshed with deltas from half a voxel to ten voxels, each within a limit of time.
The program measures each mesh (--quality); that the file holds a mesh is seen with VTK and NumPy. Prints a table, and
exits with 1 if anything failed.
"""
import argparse
import dataclasses
import json
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger
from vtkmodules.vtkIOImage import vtkNIFTIImageReader, vtkNrrdReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # of NIfTI files with two matrices
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MRICRON = pathlib.Path("/usr/share/mricron/templates")
MRICRON_LABELS = ("AICHAmc", "HarvardOxford-cort-maxprob-thr0-1mm", "JHU-WhiteMatter-labels-1mm",
                  "JHU-WhiteMatter-labels-2mm", "aal", "brodmann", "inia19-NeuroMaps", "jhu189", "natbrainlab")
ATLASES = ("spl-head-neck-atlas.nrrd", "spl-knee-atlas.nrrd")

# Deltas in edges of a cube with a voxel's volume.
DELTAS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0)

# Approximate number of elements per voxel face between labels at a delta of one voxel. It grows with 1/delta squared.
ELEMENTS_PER_FACE = 4.0
SECONDS_PER_ELEMENT = 1e-4

# Share of elements that may break the bound of their ratio: the optimiser cannot repair all of them.
POOR_SHARE = 1e-4


@dataclasses.dataclass
class Outcome:
    """One row of the table; seconds are processor time of all threads."""
    image: str
    delta: float
    status: str
    seconds: float = 0.0
    report: dict = None


def find_images():
    """Paths of images; says which are missing."""
    candidates = [MRICRON / f"{name}.nii.gz" for name in MRICRON_LABELS]
    candidates += [ROOT.parent / "shared" / "data" / name for name in ATLASES]
    for path in candidates:
        if not path.exists():
            print(f"left out: {path.name} is not there")
    return [path for path in candidates if path.exists()]


def read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def measure(path):
    """The edge of a cube with a voxel's volume, and the number of voxel faces between different labels."""
    image = read(vtkNrrdReader() if path.suffix == ".nrrd" else vtkNIFTIImageReader(), path)
    voxels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
    padded = np.pad(voxels.astype(np.int64), 1)
    faces = sum(int(np.count_nonzero(np.diff(padded, axis=axis))) for axis in range(3))
    return abs(np.prod(image.GetSpacing())) ** (1 / 3), faces


def faults_of(path, report):
    """What is wrong with a mesh and with what the program says of it."""
    grid = read(vtkXMLUnstructuredGridReader(), path)
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float64)
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    facets = np.sort(np.concatenate([np.delete(cells, i, axis=1) for i in range(4)]), axis=1)
    _, sides = np.unique(facets, axis=0, return_counts=True)
    image, quality = report["image"], report["quality"]
    return [fault for fault, count in (
        ("points that are not finite", np.count_nonzero(~np.isfinite(points))),
        ("points without a cell", len(points) - len(np.unique(cells))),
        ("cells that are not those of the report", abs(len(cells) - report["elements"])),
        ("cells that are not positive", np.count_nonzero(np.linalg.det(edges) <= 0) + quality["inverted_elements"]),
        ("facets of more than two cells", np.count_nonzero(sides > 2)),
        ("labels lost", len(image["lost_labels"])), ("labels that the image has not", len(image["extra_labels"])),
        ("components lost", len(image["lost_components"])),
        ("non-manifold edges", report["topology"]["non_manifold_edges"]),
        ("poor ratios", max(0, quality["radius_edge_violations"] - POOR_SHARE * len(cells) - 2))) if count]


def voxplex(program, arguments, seconds, memory):
    """Runs the program.

    @param seconds of processor time; ten times as long by the clock, for what waits without end
    @return (exit status or None if it took too long, standard error, seconds of processor time)
    """
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 5))

    def used():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime
    start = used()
    try:
        done = subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True,
                              timeout=10.0 * seconds, preexec_fn=limit, check=False)
    except subprocess.TimeoutExpired:
        return None, "", used() - start
    status = None if done.returncode == -signal.SIGXCPU else done.returncode
    return status, done.stderr.strip(), used() - start


def mesh_and_check(arguments, path, voxel, faces, factor, folder):
    """One image with one delta."""
    delta = factor * voxel
    expected = ELEMENTS_PER_FACE * faces * max(1.0 / factor ** 2, 0.25)
    limit = arguments.time_factor * (20.0 + SECONDS_PER_ELEMENT * expected)
    if expected > arguments.most_elements:
        return Outcome(path.name, delta, f"left out: about {expected:.2g} elements")
    mesh, statistics = folder / "mesh.vtu", folder / "statistics.json"
    flags = ["--input", path, "--delta", f"{delta:.6g}", "--output", mesh, "--threads", arguments.threads, "--quality",
             "--stats", statistics, *arguments.flags]
    status, message, seconds = voxplex(arguments.program, flags, limit, int(arguments.memory * 2 ** 30))
    if status is None:
        return Outcome(path.name, delta, f"FAILED: no end after {limit:.0f} s", seconds)
    if status < 0:
        return Outcome(path.name, delta, f"FAILED: signal {-status}", seconds)
    if status != 0:
        return Outcome(path.name, delta, f"refused: {message[:80]}", seconds)
    report = json.loads(statistics.read_text())
    faults = faults_of(mesh, report)
    mesh.unlink()
    return Outcome(path.name, delta, "FAILED: " + "; ".join(faults) if faults else "passed", seconds, report)


def print_row(outcome):
    report = outcome.report
    figures = ("", "", "", "", "", "") if report is None else (
        report["elements"], f"{1e6 * outcome.seconds / report['elements']:.1f}",
        report["topology"]["non_manifold_edges"], len(report["image"]["lost_components"]),
        f"{report['quality']['max_radius_edge']:.2f}", f"{report['quality']['min_dihedral']:.1f}")
    row = outcome.image, f"{outcome.delta:.4g}", f"{outcome.seconds:.1f}", *figures, outcome.status
    print("| " + " | ".join(map(str, row)) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build" / "release" / "bin" / "voxplex")
    parser.add_argument("--images", default="", help="only images with this in their name")
    parser.add_argument("--deltas", default=",".join(map(str, DELTAS)), help="in voxels, with commas")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--time-factor", type=float, default=1.0, help="multiplies the limits of time")
    parser.add_argument("--memory", type=float, default=12.0, help="address space of the program, GiB")
    parser.add_argument("--most-elements", type=float, default=6e6, help="leave out what is expected to have more")
    parser.add_argument("flags", nargs="*", help="further flags of voxplex, after --")
    arguments = parser.parse_args()

    failed = 0
    print("| image | delta | seconds | elements | us/element | non-manifold edges | lost components | ratio | "
          "dihedral | |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for path in find_images():
            if arguments.images not in path.name:
                continue
            voxel, faces = measure(path)
            for factor in map(float, arguments.deltas.split(",")):
                outcome = mesh_and_check(arguments, path, voxel, faces, factor, pathlib.Path(folder))
                print_row(outcome)
                failed += outcome.status.startswith("FAILED")
    print(f"{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
