# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The program voxplex, which makes the mesh: it is installed if need be, and runs as a process of its own."""
import importlib
import json
import re
import subprocess
import tempfile
from pathlib import Path

import qt
import slicer

from VoxplexMesherLib.Logic import MeshingError, Phase, RunState
from VoxplexMesherLib.Scene import loadMesh, writeImages

PACKAGE = "voxplex-mesh"  # `voxplex` on PyPI is another project
QUESTION = ("The mesh is made by the program of the Python package %s, which this Slicer does not have yet. "
            "Download it from PyPI, and install it into Slicer's Python?" % PACKAGE)


def loadPackage():
    """The Python package voxplex. Raises ImportError, also if it is another one of this name."""
    importlib.import_module("voxplex.images")
    importlib.import_module("voxplex.program")
    return importlib.import_module("voxplex")


def isInstalled():
    try:
        loadPackage()
    except ImportError:
        return False
    return True


def requirePackage():
    """The package, which the user is asked to install if it is missing; None if they refuse. Raises MeshingError."""
    if not isInstalled():
        if not slicer.util.confirmOkCancelDisplay(QUESTION, windowTitle="Voxplex Mesher"):
            return None
        try:
            slicer.util.pip_install("--only-binary=:all: " + PACKAGE)
        except (OSError, RuntimeError, subprocess.CalledProcessError):
            raise MeshingError("%s could not be installed. Slicer's Python console says why: perhaps PyPI cannot be reached, "
                               "or has none for this system or this version of Slicer" % PACKAGE) from None
        importlib.invalidate_caches()
    try:
        package = loadPackage()
        if not Path(package.program.path()).exists():  # a checkout has none
            raise RuntimeError(package.program.no_start("nothing"))
        return package
    except (ImportError, RuntimeError) as error:
        raise MeshingError("%s is installed, but cannot be used: %s. Restart Slicer" % (PACKAGE, error)) from None


class ProgramRunner:
    """Runs the program on some segments of a segmentation, or on a volume.

    The image goes to it, and the mesh comes back, through files in a temporary folder. The results are in the output nodes
    before the run counts as completed.
    """

    PROGRESS = re.compile(r"(\d+) % (.*)")

    def __init__(self):
        self.folder = self.onChange = None
        self.isCancelled = False
        self.process = qt.QProcess()
        self.process.connect("readyReadStandardError()", self._onText)
        self.process.connect("finished(int,QProcess::ExitStatus)", self._onFinished)
        self.process.connect("errorOccurred(QProcess::ProcessError)", self._onError)

    def prepare(self, inputNode, segments, meshNode, surfacesNode=None):
        """What the next start() works on: a segmentation node, or a volume node."""
        self.inputs = (inputNode, segments)
        self.outputs = {"mesh.vtu": meshNode, "interfaces.vtp": surfacesNode}

    def start(self, options, onChange):
        self.onChange, self.isCancelled = onChange, False
        self.said, self.rest = [], b""
        package = requirePackage()  # Slicer may process events meanwhile
        if package is None or self.isCancelled:
            onChange(RunState(Phase.CANCELLED))
            return
        try:
            self.folder = tempfile.TemporaryDirectory(prefix="voxplex-", dir=slicer.app.temporaryPath)
            self.images = writeImages(package.images, *self.inputs, self.folder.name)
        except (OSError, MeshingError) as error:
            if self.folder is not None:
                self.folder.cleanup()
            raise MeshingError(str(error)) from None
        files = [*("--input=" + path for path in self.images), "--output=" + self._path("mesh.vtu"),
                 "--stats=" + self._path("figures.json")]
        if self.outputs["interfaces.vtp"] is not None:
            files.append("--plc=" + self._path("interfaces.vtp"))
        self.process.setProcessEnvironment(slicer.app.startupEnvironment())  # without Slicer's own libraries
        self.process.start(package.program.path(), [*files, "--space=ras", "--uncompressed", "--progress", *options])

    def cancel(self):
        self.isCancelled = True
        self.process.kill()

    def _path(self, name):
        return str(Path(self.folder.name) / name)

    def _onText(self):
        *lines, self.rest = (self.rest + bytes(self.process.readAllStandardError().data())).split(b"\n")
        for line in (line.decode(errors="replace") for line in lines):
            found = self.PROGRESS.match(line)
            if found:
                self.onChange(RunState(Phase.RUNNING, int(found[1]) / 100.0, found[2]))
            elif line != "voxplex: see voxplex --help":
                for path, name in self.images.items():
                    line = line.replace(path, name)
                self.said.append(line)

    def _onError(self, error):
        if error == qt.QProcess.FailedToStart:  # otherwise it has finished, too
            self._end(RunState(Phase.FAILED, message="the program voxplex cannot be started"))

    def _onFinished(self, status, exitStatus):
        said = "\n".join([*self.said, self.rest.decode(errors="replace")]).strip()
        if self.isCancelled:
            self._end(RunState(Phase.CANCELLED))
        elif exitStatus != qt.QProcess.NormalExit:
            self._end(RunState(Phase.FAILED, message="the program voxplex crashed, or was ended\n" + said))
        elif status != 0:
            self._end(RunState(Phase.FAILED, message=said))
        else:
            for name, node in self.outputs.items():
                if node is not None:
                    loadMesh(node, self._path(name))
            figures = json.loads(Path(self._path("figures.json")).read_text())
            self._end(RunState(Phase.COMPLETED, 1.0, warnings=said, figures=figures))

    def _end(self, state):
        self.folder.cleanup()
        self.onChange(state)
