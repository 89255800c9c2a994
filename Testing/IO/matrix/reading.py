# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads images in a process of its own, which lives through all of them or is replaced."""
import multiprocessing
import os
import resource
import signal
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

MOST_BYTES = 1 << 22  # of voxels that are brought to the test
MOST_PRINTED = 500  # bytes of what is printed that a test shows


@dataclass
class Result:
    """What came of reading one image. fault: the host died, was hung, or something was printed."""
    names: tuple
    message: str = ""
    shape: tuple = ()
    type: str = ""
    voxels: np.ndarray = None  # [n, k, j, i]
    affine: np.ndarray = None
    times: tuple = ()
    warnings: tuple = ()
    resident: int = 0  # the most bytes of the process and of one child of it
    fault: str = ""


class Host:
    """A process that has loaded the reader. It stands for Python, ParaView or 3D Slicer."""

    def __init__(self, timeout=10):
        self._timeout = timeout
        self._process = None
        self.starts = 0

    def read(self, path):
        name = Path(path).name
        names = name, name.replace(".img", ".hdr")  # a pair may be called by its header
        if self._process is None:
            self._start()
        self._pipe.send(str(path))
        try:
            if self._pipe.poll(self._timeout):
                result = self._pipe.recv()
                result.names = names
                return result
            fault = "hangs for %d s" % self._timeout
        except (EOFError, ConnectionResetError):
            self._process.join()
            code = self._process.exitcode
            fault = "the host dies: " + (signal.Signals(-code).name if code < 0 else "exit status %d" % code)
            printed = os.pread(self._printed.fileno(), MOST_PRINTED, 0).decode(errors="replace").strip()
            fault += printed and ", and prints: " + printed
        self.stop()
        return Result(names, fault=fault)

    def stop(self):
        if self._process is None:
            return
        try:
            os.killpg(self._process.pid, signal.SIGKILL)  # with the helpers that it has started
        except ProcessLookupError:
            self._process.kill()
        self._process.join()
        self._pipe.close()
        self._printed.close()
        self._process = None

    def _start(self):
        context = multiprocessing.get_context("fork")
        self._pipe, theirs = context.Pipe()
        self._printed = tempfile.TemporaryFile()
        self._process = context.Process(target=_serve, args=(theirs, self._pipe, self._printed.fileno()))
        self._process.start()
        theirs.close()
        self.starts += 1
        if not self._pipe.poll(120) or self._pipe.recv() != "ready":
            raise RuntimeError("the reader cannot be loaded")


def _serve(pipe, other_end, printed):
    other_end.close()
    os.setsid()
    import voxplex
    from vtkmodules.vtkCommonCore import vtkObject
    vtkObject.GlobalWarningDisplayOff()
    os.dup2(printed, 1)
    os.dup2(printed, 2)
    pipe.send("ready")
    while True:
        try:
            path = pipe.recv()
        except EOFError:
            return
        Path("/proc/self/clear_refs").write_text("5")  # the peak begins anew
        result = _read(voxplex, path)
        result.resident = _resident()
        if os.fstat(printed).st_size:
            result.fault = "prints: " + os.pread(printed, MOST_PRINTED, 0).decode(errors="replace")
            os.ftruncate(printed, 0)
            os.lseek(printed, 0, os.SEEK_SET)
        pipe.send(result)


def _read(voxplex, path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    reader = voxplex.vtkSegmentationReader()
    reader.SetFileName(path)
    reader.Update()
    count = reader.GetNumberOfFrames()
    result = Result((), message=reader.GetErrorMessage(),
                    warnings=tuple(reader.GetWarning(i) for i in range(reader.GetNumberOfWarnings())))
    if "its reading ended" in result.message:
        result.fault = result.message
    image = reader.GetOutput()
    if result.message or count == 0:
        if not result.message or count or image.GetNumberOfPoints():
            result.fault = "%d frames, %d voxels and the message '%s'" % (
                count, image.GetNumberOfPoints(), result.message)
        return result
    labels = image.GetPointData().GetArray("Labels")
    result.shape, result.type = (count, *image.GetDimensions()[::-1]), labels.GetDataTypeAsString()
    result.times = tuple(reader.GetTimeOfFrame(n) for n in range(count))
    result.affine = _affine(image)
    if count * image.GetNumberOfPoints() * labels.GetDataTypeSize() <= MOST_BYTES:
        frames = []
        for time in result.times:
            reader.UpdateTimeStep(time)
            labels = reader.GetOutput().GetPointData().GetArray("Labels")
            frames.append(vtk_to_numpy(labels).reshape(result.shape[1:]).copy())
        result.voxels = np.stack(frames)
    return result


def _affine(image):
    points = []
    for index in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 0)):
        point = [0.0] * 3
        image.TransformContinuousIndexToPhysicalPoint([float(i) for i in index], point)
        points.append(point)
    points = np.array(points).T
    points[:, :3] -= points[:, 3:]
    return points


def _resident():
    """Bytes of this process at its peak, and of the largest child, whether it has ended or not."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss << 10
    for task in Path("/proc/self/task").iterdir():
        for child in (task / "children").read_text().split():
            children = max(children, _peak(child))
    return _peak("self") + children


def _peak(process):
    try:
        status = Path("/proc/%s/status" % process).read_text()
    except (FileNotFoundError, ProcessLookupError):
        return 0
    lines = [line.split() for line in status.splitlines() if line.startswith("VmHWM:")]
    return int(lines[0][1]) << 10 if lines else 0
