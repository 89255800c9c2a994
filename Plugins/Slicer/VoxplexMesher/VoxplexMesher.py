# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The scripted module Voxplex Mesher of 3D Slicer. Slicer looks here for its classes; VoxplexMesherLib has what they do."""
from slicer.ScriptedLoadableModule import ScriptedLoadableModule

from VoxplexMesherLib.ModuleLogic import VoxplexMesherLogic  # noqa: F401 (Slicer finds these by their names)
from VoxplexMesherLib.SelfTest import VoxplexMesherTest  # noqa: F401
from VoxplexMesherLib.Widget import VoxplexMesherWidget  # noqa: F401


class VoxplexMesher(ScriptedLoadableModule):
    """What the module is."""

    def __init__(self, parent):
        ScriptedLoadableModule.__init__(self, parent)
        parent.title = "Voxplex Mesher"
        parent.categories = ["Segmentation"]
        parent.dependencies = ["Segmentations"]
        parent.contributors = ["The Voxplex developers"]
        parent.helpText = ("Turns segments into a conforming mesh of tetrahedra for finite elements: choose a "
                           "segmentation, uncheck what shall become background, give a delta, and press Apply. "
                           "Documentation/Slicer.md in the Voxplex repository says more.")
        parent.acknowledgementText = ("The method is that of P. Foteinos, Real-time high-quality image-to-mesh conversion "
                                      "for finite element simulations (2013).")
