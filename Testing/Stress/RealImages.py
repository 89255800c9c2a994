#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes label images of patients and atlases with the program voxplex, and checks every mesh.

The images are those of Debian's package mricron-data and the two atlases of ../shared/data; those that are not there
are left out, with a message. Each is meshed with deltas from half a voxel to ten voxels, each within a limit of time.
The meshes are checked by CheckMeshFile.py. Prints a table, and exits with 1 if anything failed.
"""
import argparse
import dataclasses
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE))

import CheckMeshFile  # noqa: E402 (beside this file)

MRICRON = pathlib.Path("/usr/share/mricron/templates")
MRICRON_LABELS = ("AICHAmc", "HarvardOxford-cort-maxprob-thr0-1mm", "JHU-WhiteMatter-labels-1mm",
                  "JHU-WhiteMatter-labels-2mm", "aal", "brodmann", "inia19-NeuroMaps", "jhu189", "natbrainlab")
ATLASES = ("spl-head-neck-atlas.nrrd", "spl-knee-atlas.nrrd")

# Deltas in edges of a cube with a voxel's volume.
DELTAS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0)

# Approximate number of elements per voxel face between labels at a delta of one voxel. It grows with 1/delta squared.
ELEMENTS_PER_FACE = 4.0
SECONDS_PER_ELEMENT = 1e-4


@dataclasses.dataclass
class Outcome:
    """One row of the table; seconds are processor time of all threads."""
    image: str
    delta: float
    status: str
    seconds: float = 0.0
    elements: int = 0
    figures: dict = dataclasses.field(default_factory=dict)


def find_images():
    """Paths of images; says which are missing."""
    candidates = [MRICRON / f"{name}.nii.gz" for name in MRICRON_LABELS]
    candidates += [ROOT.parent / "shared" / "data" / name for name in ATLASES]
    for path in candidates:
        if not path.exists():
            print(f"left out: {path.name} is not there")
    return [path for path in candidates if path.exists()]


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


def mesh_and_check(arguments, path, image, factor, folder):
    """One image with one delta."""
    voxel = image.voxel_volume() ** (1.0 / 3.0)
    delta = factor * voxel
    expected = ELEMENTS_PER_FACE * image.interface_faces() * max(1.0 / factor ** 2, 0.25)
    limit = arguments.time_factor * (20.0 + SECONDS_PER_ELEMENT * expected)
    if expected > arguments.most_elements:
        return Outcome(path.name, delta, f"left out: about {expected:.2g} elements")
    mesh = folder / "mesh.vtu"
    flags = ["--input", path, "--delta", f"{delta:.6g}", "--output", mesh, "--threads", arguments.threads,
             *arguments.flags]
    status, message, seconds = voxplex(arguments.program, flags, limit, int(arguments.memory * 2 ** 30))
    if status is None:
        return Outcome(path.name, delta, f"FAILED: no end after {limit:.0f} s", seconds)
    if status < 0:
        return Outcome(path.name, delta, f"FAILED: signal {-status}", seconds)
    if status != 0:
        return Outcome(path.name, delta, f"refused: {message[:80]}", seconds)
    figures, faults = CheckMeshFile.check(image, mesh)
    mesh.unlink()
    return Outcome(path.name, delta, "FAILED: " + "; ".join(faults) if faults else "passed", seconds,
                   figures["elements"], figures)


def print_row(outcome):
    figures = outcome.figures
    rate = 1e6 * outcome.seconds / outcome.elements if outcome.elements else 0.0
    print(f"| {outcome.image} | {outcome.delta:.4g} | {outcome.elements} | {outcome.seconds:.1f} | {rate:.1f} | "
          f"{figures.get('non_manifold', '')} | {figures.get('lost', '')} | {figures.get('worst_ratio', 0.0):.2f} | "
          f"{figures.get('smallest_dihedral', 0.0):.1f} | {outcome.status} |", flush=True)


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
    print("| image | delta | elements | seconds | us/element | non-manifold edges | lost components | ratio | "
          "dihedral | |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |")
    with tempfile.TemporaryDirectory() as folder:
        for path in find_images():
            if arguments.images not in path.name:
                continue
            image = CheckMeshFile.Image(path)
            for factor in map(float, arguments.deltas.split(",")):
                outcome = mesh_and_check(arguments, path, image, factor, pathlib.Path(folder))
                print_row(outcome)
                failed += outcome.status.startswith("FAILED")
    print(f"{failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
