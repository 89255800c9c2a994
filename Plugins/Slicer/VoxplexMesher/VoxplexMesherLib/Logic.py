# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the module decides, computes and says; needs VTK but not Slicer.

One run is: choose segments and settings, hand the options of the program voxplex to a runner, follow its progress, and give
the finished mesh the names and colours of the segments. A runner carries the program out: in Slicer it is
Program.ProgramRunner. It has two methods:

    start(options, onChange)   begins, and calls onChange(RunState) until the state is final
    cancel()                   asks for an end
"""
from __future__ import annotations

import enum
import json
import math
from dataclasses import asdict, dataclass, field, fields, make_dataclass, replace
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import VTK_TETRA


class MeshingError(Exception):
    """The user can mend it; the text says how."""


@dataclass
class Segment:
    """A segment and what was chosen for it."""
    id: str
    name: str
    color: tuple  # red, green, blue, from 0 to 1
    mesh: bool = True  # otherwise it becomes background
    sizes: dict = field(default_factory=dict)  # lengths that are not 0, by the names in SIZES


# The parameters of meshing by their names in Slicer: those of single segments, and those of all. The inside of an isosurface has
# the label 1 here.
_DEFAULTS, *_ROWS = json.loads(Path(__file__).with_name("Parameters.json").read_text(encoding="utf-8"))
TABLE = [{**_DEFAULTS, **row} for row in _ROWS]  # as Parameters/write_slicer.py writes it
SIZES = {p["slicer"]: p for p in TABLE if p["kind"] == "label-sizes"}
PARAMETERS = {p["slicer"]: p for p in TABLE if p["kind"] not in ("labels", "label-sizes") and p["slicer"] not in ("", "insideLabel")}


def _default(parameter):
    """0 is no number."""
    kind, default = parameter["kind"], parameter["default"]
    if kind == "flag":
        return default == "on"
    return {"real": float, "whole": int}.get(kind, str)(default or ("" if kind == "interface-sizes" else 0))


class _Texts:
    """Settings in a parameter node."""

    @classmethod
    def fromTexts(cls, text):
        """From a parameter node; text(name) gives what is stored, or an empty text."""
        settings = cls()
        for setting in fields(cls):
            stored = text(setting.name)
            if stored:
                setattr(settings, setting.name, _parse(stored, getattr(settings, setting.name)))
        return settings

    def toTexts(self):
        """For a parameter node."""
        return {name: value if isinstance(value, str) else str(value).lower() if isinstance(value, bool) else repr(value)
                for name, value in asdict(self).items()}


DEFAULTS = {**{name: _default(parameter) for name, parameter in PARAMETERS.items()}, "quality": False}
Settings = make_dataclass("Settings", [(name, type(value), value) for name, value in DEFAULTS.items()], bases=(_Texts,))
Settings.__doc__ = """Lengths are in millimetres. Names and defaults are those of the table. Interface sizes are those of parseInterfaceSizes()."""


def _parse(text, default):
    try:
        return text in ("true", "on") if isinstance(default, bool) else type(default)(text)
    except ValueError:
        return default  # a scene that was edited by hand


class Phase(enum.Enum):
    IDLE = "idle"
    RUNNING = "running"
    CANCELLING = "cancelling"
    COMPLETED = "completed"
    CANCELLED = "cancelled"
    FAILED = "failed"

    @property
    def isFinal(self):
        return self in (Phase.COMPLETED, Phase.CANCELLED, Phase.FAILED)


@dataclass
class RunState:
    """What a runner tells."""
    phase: Phase
    progress: float = 0.0  # 0 to 1
    message: str = ""  # the present stage; if it failed, why
    warnings: str = ""
    figures: dict = field(default_factory=dict)  # of a completed run: the program's statistics


# --- Choices of segments ------------------------------------------------------------------------------------

def mergeChoices(segments, stored):
    """The segments with the choices that a parameter node has stored for those of the same id.

    Segments without a stored choice are meshed; choices for segments that no longer exist are dropped."""
    try:
        choices = json.loads(stored) if stored else {}
    except json.JSONDecodeError:
        choices = {}
    merged = []
    for segment in segments:
        choice = choices.get(segment.id, {})
        sizes = {name: float(choice[name]) for name in SIZES if name in choice}
        merged.append(replace(segment, mesh=bool(choice.get("mesh", True)), sizes=sizes))
    return merged


def storeChoices(segments):
    """The choices as one text, for a parameter node."""
    return json.dumps({segment.id: {"mesh": segment.mesh, **segment.sizes} for segment in segments})


def parseSize(text, isSigned=False):
    """The size that a user typed: 0 if nothing. Raises MeshingError."""
    text = text.strip().replace(",", ".")
    try:
        size = float(text) if text else 0.0
    except ValueError:
        size = math.nan
    if not math.isfinite(size) or (size < 0.0 and not isSigned):
        raise MeshingError("'%s' is not a size: type a length in millimetres, or nothing for no bound" % text)
    return size


def setSize(segment, name, text):
    """What a user typed for one of SIZES. Raises MeshingError."""
    size = parseSize(text, isSigned=SIZES[name]["range"][0] is None)
    segment.sizes = {**segment.sizes, name: size}
    if not size:
        del segment.sizes[name]


def meshedSegments(segments):
    """Those that are meshed; their labels are 1, 2, ... in this order, as Slicer exports them."""
    return [segment for segment in segments if segment.mesh]


# --- Options of the program ---------------------------------------------------------------------------------

def _isIdle(parameter, settings, isosurface):
    """Whether the table says that it does not count beside the other settings."""
    def isGiven(name):
        return isosurface if name == "isovalue" else getattr(settings, name) != DEFAULTS[name]

    return bool(parameter["needs"] and not isGiven(parameter["needs"]) or parameter["excludes"] and isGiven(parameter["excludes"]))


def programOptions(segments, settings, isosurface=False):
    """The options of the program, but for those that name files. Of an isosurface there is one segment, its inside. What
    does not count is left out: delta beside a number of elements, what belongs to grading without it, and so on. Raises
    MeshingError."""
    chosen = meshedSegments(segments)
    if not chosen:
        raise MeshingError("No segment is chosen: check at least one in the table")
    for name in ("delta", "elements", "size", "smoothing"):
        if not (math.isfinite(getattr(settings, name)) and getattr(settings, name) >= 0.0):
            raise MeshingError("%s must be 0 or more" % name.capitalize())
    other = ("smoothing",) if isosurface else ("isovalue", "greySmoothing")  # one option of the program
    options = ["--%s=%d=%r" % (SIZES[name]["option"], label, size)
               for label, segment in enumerate(chosen, 1) for name, size in segment.sizes.items()
               if not _isIdle(SIZES[name], settings, isosurface)]
    for name, parameter in PARAMETERS.items():
        if parameter["kind"] == "interface-sizes":
            options += ["--%s=%s" % (parameter["option"], item) for item in parseInterfaceSizes(getattr(settings, name), chosen)]
        elif name not in other and not _isIdle(parameter, settings, isosurface):
            options += _options(parameter, getattr(settings, name))
    if settings.quality and not isosurface:
        options.append("--hausdorff")
    return options


def _options(parameter, value):
    """Of a flag, if it is not as it is by default; of a number, unless it stands for none."""
    name = "--" + (parameter["option"] or "smoothing")  # of grey values and of labels, it is one option
    if parameter["kind"] == "flag":
        return [name] if value != (parameter["default"] == "on") else []
    if value == 0 and parameter["default"] == "" and parameter["zero"]:
        return []
    return ["%s=%s" % (name, value)]


def parseInterfaceSizes(text, chosen):
    """Interface sizes with names as the user types them, such as "Bone = 0.5; Bone : Muscle = 0.4; Skin : background = 2", with
    labels as the program wants them: "1=0.5", "1,2=0.4", "3,0=2". Raises MeshingError."""
    labels = {"background": 0, **{segment.name: label for label, segment in enumerate(chosen, 1)}}
    items = []
    for item in filter(None, (part.strip() for part in text.split(";"))):
        names, equals, size = item.rpartition("=")
        pair = _splitNames(names.strip(), labels)
        if not equals or pair is None or not parseSize(size) > 0.0:
            raise MeshingError("'%s' is not the size of an interface: write NAME = LENGTH, or NAME : NAME = LENGTH, with names of "
                               "segments that are meshed, or background" % item)
        items.append(",".join(str(labels[name]) for name in pair) + "=%r" % parseSize(size))
    return items


def _splitNames(text, labels):
    """One known name, or two; names may have colons themselves."""
    if text in labels:
        return (text,)
    for place in (place for place, letter in enumerate(text) if letter == ":"):
        pair = text[:place].strip(), text[place + 1:].strip()
        if pair[0] in labels and pair[1] in labels:
            return pair
    return None


# --- The mesh -----------------------------------------------------------------------------------------------

def segmentsByLabel(segments, figures):
    """What has which label in the mesh: the segments that are meshed, and the shells that the program's statistics have."""
    labels = dict(enumerate(meshedSegments(segments), 1))
    for row in figures.get("repair", ()):
        if "new_label" in row:
            inner = labels[row["label"]]
            labels[row["new_label"]] = replace(inner, name=inner.name + " shell", color=tuple((1 + c) / 2 for c in inner.color))
    return labels


def labelMesh(mesh, labels):
    """Adds the names and colours of segments, by their labels, as field data: LabelValues, LabelNames, LabelColors."""
    values, names, colors = vtkIntArray(), vtkStringArray(), vtkDoubleArray()
    colors.SetNumberOfComponents(3)
    for label, segment in labels.items():
        values.InsertNextValue(label)
        names.InsertNextValue(segment.name)
        colors.InsertNextTuple(segment.color)
    for name, array in (("LabelValues", values), ("LabelNames", names), ("LabelColors", colors)):
        array.SetName(name)
        mesh.GetFieldData().RemoveArray(name)
        mesh.GetFieldData().AddArray(array)


@dataclass
class LabelFigures:
    label: int
    elements: int
    volume: float


def measureLabels(mesh):
    """The number and the volume of the tetrahedra of each label. Raises MeshingError if it is no such mesh."""
    array = mesh.GetCellData().GetArray("Label") if mesh else None
    if array is None or mesh.GetNumberOfCells() == 0:
        raise MeshingError("The program made no tetrahedra")
    if not mesh.IsHomogeneous() or mesh.GetCellType(0) != VTK_TETRA:
        raise MeshingError("The mesh has other cells than tetrahedra")
    labels = vtk_to_numpy(array)
    corners = vtk_to_numpy(mesh.GetPoints().GetData())[
        vtk_to_numpy(mesh.GetCells().GetConnectivityArray()).reshape(-1, 4)].astype(float)
    edges = corners[:, 1:] - corners[:, :1]
    volumes = np.abs(np.linalg.det(edges)) / 6.0
    values, places = np.unique(labels, return_inverse=True)
    return [LabelFigures(int(label), int(elements), float(volume)) for label, elements, volume in
            zip(values, np.bincount(places), np.bincount(places, volumes))]


def describeMesh(mesh, labels):
    """Lines for the log about a mesh of segments, which have labels."""
    figures = measureLabels(mesh)
    lines = ["%d tetrahedra with %d nodes" % (mesh.GetNumberOfCells(), mesh.GetNumberOfPoints())]
    lines += ["  %s: %d tetrahedra, %.4g mm³" % (labels[f.label].name if f.label in labels else "label %d" % f.label,
                                                f.elements, f.volume) for f in figures]
    found = {f.label for f in figures}
    lines += ["  %s: none; it is too small for this delta" % segment.name for label, segment in labels.items() if label not in found]
    return lines


def describeQuality(figures):
    """Lines for the log about the statistics of the program."""
    lines = ["Dihedral angles from %(min_dihedral).1f to %(max_dihedral).1f degrees, radius-edge ratio at most "
             "%(max_radius_edge).2f, angles of triangles from %(min_planar).1f degrees" % figures["quality"]]
    if "hausdorff" in figures:
        lines.append("Hausdorff distance %.3g mm, %d non-manifold edges, volumes of segments off by up to %.2g %%" % (
            figures["hausdorff"]["voxels"]["distance"], figures["topology"]["non_manifold_edges"],
            100.0 * max(abs(label["volume_error"]) for label in figures["labels"].values())))
    return lines


# --- One run ------------------------------------------------------------------------------------------------

class MeshingLogic:
    """Carries one run after the other out, with a runner."""

    def __init__(self, runner, log=lambda line: None, onChange=lambda state: None):
        self.runner = runner
        self.log = log
        self.onChange = onChange
        self.state = RunState(Phase.IDLE)

    @property
    def isBusy(self):
        return self.state.phase in (Phase.RUNNING, Phase.CANCELLING)

    def start(self, segments, settings, isosurface=False):
        """Begins a run. Raises MeshingError if the choices do not do, or another run is under way."""
        if self.isBusy:
            raise MeshingError("A mesh is being made: wait for it, or cancel it")
        options = programOptions(segments, settings, isosurface)
        self.log("Meshing " + ", ".join(segment.name for segment in meshedSegments(segments)))
        self._change(RunState(Phase.RUNNING))
        try:
            self.runner.start(options, self._onRunnerChange)
        except Exception as error:
            self._onRunnerChange(RunState(Phase.FAILED, message=str(error)))
            raise

    def cancel(self):
        """Asks the run, if there is one, to end."""
        if self.state.phase is Phase.RUNNING:
            self._change(replace(self.state, phase=Phase.CANCELLING))
            self.runner.cancel()

    def _onRunnerChange(self, state):
        if not self.isBusy:
            return  # an echo of a run that has ended
        if not state.phase.isFinal and self.state.phase is Phase.CANCELLING:
            return
        if state.warnings:
            self.log(state.warnings.strip())
        if state.phase is Phase.FAILED:
            self.log("Failed: " + (state.message.strip() or "the program gave no reason"))
        elif state.phase is Phase.CANCELLED:
            self.log("Cancelled")
        self._change(state)

    def _change(self, state):
        self.state = state
        self.onChange(state)
