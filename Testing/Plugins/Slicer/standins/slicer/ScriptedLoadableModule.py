# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for slicer.ScriptedLoadableModule: the base classes of scripted modules."""
import types
import unittest

import qt
import slicer


class ScriptedLoadableModule:
    def __init__(self, parent):
        super().__init__()
        self.parent = parent


class ScriptedLoadableModuleWidget:
    def __init__(self, parent=None):
        super().__init__()
        self.parent = parent or types.SimpleNamespace(isEntered=True)
        self.layout = qt.QVBoxLayout()

    def setup(self):
        pass


class ScriptedLoadableModuleLogic:
    def __init__(self, parent=None):
        super().__init__()
        self.moduleName = type(self).__name__[:-len("Logic")]

    def getParameterNode(self):
        scene = slicer.mrmlScene
        return (scene.GetSingletonNode(self.moduleName, "vtkMRMLScriptedModuleNode")
                or scene.AddNewNodeByClass("vtkMRMLScriptedModuleNode", self.moduleName))


class ScriptedLoadableModuleTest(unittest.TestCase):
    pass
