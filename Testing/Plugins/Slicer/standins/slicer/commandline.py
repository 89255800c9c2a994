# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a CLI module as Slicer does: the command line is made from the module's own description, images and models go
through temporary files, progress is read from standard output, values that the module returns from a file, and
cancelling kills the process."""
import re
import subprocess
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import images
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

from slicer.nodes import vtkMRMLNode

READERS = {".vtu": vtkXMLUnstructuredGridReader, ".vtp": vtkXMLPolyDataReader}


class vtkMRMLCommandLineModuleNode(vtkMRMLNode):
    Idle, Scheduled, Running, Cancelling, Cancelled, Completed, ErrorsMask = 0, 1, 2, 4, 8, 0x10, 0x20
    BusyMask = Scheduled | Running | Cancelling
    NAMES = {0: "Idle", 1: "Scheduled", 2: "Running", 4: "Cancelling", 8: "Cancelled", 0x10: "Completed",
             0x30: "Completed with errors"}

    def __init__(self):
        super().__init__("Segmentation To Tetrahedral Mesh")
        self.status, self.progress, self.output, self.errors = self.Scheduled, 0, "", ""
        self.parameters, self.process, self.folder = {}, None, None

    def GetStatus(self):
        return self.status

    def GetStatusString(self):
        return self.NAMES[self.status]

    def IsBusy(self):
        return bool(self.status & self.BusyMask)

    def GetProgress(self):
        return self.progress

    def GetErrorText(self):
        return self.errors

    def GetParameterAsString(self, name):
        value = self.parameters.get(name, self.module.parameters[name].findtext("default") or "")
        return value.GetID() if isinstance(value, vtkMRMLNode) else str(value)

    def Cancel(self):
        if self.IsBusy():
            self._become(self.Cancelling)

    def _become(self, status):
        self.status = status
        self.Modified()


class Module:
    """slicer.modules.segmentationtotetmesh"""

    def __init__(self, executable):
        self.executable = executable
        xml = subprocess.run([executable, "--xml"], capture_output=True, check=True).stdout
        self.parameters = {p.findtext("name"): p for group in ElementTree.fromstring(xml).findall("parameters")
                           for p in group if p.find("name") is not None}


def _command(module, node):
    """As vtkSlicerCLIModuleLogic makes it: flags first, then what comes by its place."""
    flags, places = [], {}
    for name, p in module.parameters.items():
        value = node.parameters.get(name, p.findtext("default") or "")
        if isinstance(value, vtkMRMLNode):
            value = str(_file(p, name, node))
        flag, index = p.findtext("longflag"), p.findtext("index")
        if index is not None:
            places[int(index)] = value
        elif p.tag == "boolean":
            flags += [flag] if value in (True, "true") else []
        elif flag and value != "":
            flags += [flag, str(value)]
    return [module.executable, "--returnparameterfile", str(_returnFile(node)), *flags,
            *(places[index] for index in sorted(places))]


def _returnFile(node):
    return Path(node.folder.name) / "returned.params"


def _file(p, name, node):
    return Path(node.folder.name) / (name + p.get("fileExtensions").split(",")[0])


class Runner:
    """slicer.cli and what Slicer does while it processes events."""

    def __init__(self, scene):
        self.scene, self.running = scene, []
        self.commands = []

    def run(self, module, node, parameters, wait_for_completion, update_display):
        if node is not None or wait_for_completion:
            raise AssertionError("not needed here")
        unknown = set(parameters) - set(module.parameters)
        if unknown:
            raise AssertionError("the module has no parameters %s" % unknown)
        node = vtkMRMLCommandLineModuleNode()
        node.module = module
        for name, value in parameters.items():
            if not isinstance(value, (str, bool, int, float, vtkMRMLNode)):
                raise TypeError("parameter %s has the unsupported type %s" % (name, type(value)))
            node.parameters[name] = value
        self.scene.AddNode(node)
        self.running.append(node)
        return node

    def processEvents(self):
        for node in list(self.running):
            self._proceed(node)

    def _proceed(self, node):
        if node.status == node.Scheduled:
            self._start(node)
        elif node.status == node.Cancelling:
            if node.process:
                node.process.kill()
                node.process.communicate()
            self._end(node, node.Cancelled)
        else:
            self._read(node)

    def _start(self, node):
        node.folder = tempfile.TemporaryDirectory(prefix="voxplex-slicer-")
        for name, value in node.parameters.items():
            p = node.module.parameters[name]
            if isinstance(value, vtkMRMLNode) and p.findtext("channel") == "input":
                images.write_nrrd(_file(p, name, node), value.array, value.geometry)
        command = _command(node.module, node)
        self.commands.append(command)
        node.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        node._become(node.Running)

    def _read(self, node):
        line = node.process.stdout.readline()
        node.output += line
        found = re.match("<filter-progress>(.*)</filter-progress>", line)
        if found:
            node.progress = round(100 * float(found.group(1)))
            node.Modified()
        if line:
            return
        node.errors = node.process.communicate()[1]
        if node.process.returncode != 0:
            self._end(node, node.Completed | node.ErrorsMask)
            return
        for line in _returnFile(node).read_text().splitlines():
            name, _, text = line.partition(" = ")
            if node.module.parameters[name].find("longflag") is not None:
                raise AssertionError("%s is not returned" % name)
            node.parameters[name] = text
        for name, value in node.parameters.items():
            p = node.module.parameters[name]
            if isinstance(value, vtkMRMLNode) and p.findtext("channel") == "output":
                path = _file(p, name, node)
                reader = READERS[path.suffix]()
                reader.SetFileName(str(path))
                reader.Update()
                value.mesh = reader.GetOutput()
        self._end(node, node.Completed)

    def _end(self, node, status):
        self.running.remove(node)
        if node.folder:
            node.folder.cleanup()
        node._become(status)
