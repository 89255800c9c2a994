# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the Voxplex plugin adds to ParaView's Python. It can be imported once the plugin is loaded.

    from paraview.simple import LoadPlugin
    LoadPlugin("VoxplexMeshing.so", ns=globals())
    import voxplex_paraview
"""


def apply_label_colors(source):
    """Shows the names and colours of labels that the data of a source carries.

    The colour maps of the arrays `Label` and `Labels` become categorical: each label's name is its annotation (its value
    where it has no name), and its colour that of its category. Colour maps belong to names of arrays,
    so all that is coloured by these arrays follows. ParaView's window does this by itself.

    source: a pipeline object, or one of its output ports. Its pipeline is updated if need be.
    """
    from paraview import servermanager

    source.UpdatePipeline()
    manager = servermanager.ActiveConnection.Session.GetSessionProxyManager()
    colors = manager.NewProxy("misc", "VoxplexLabelColors")
    servermanager.vtkSMPropertyHelper(colors, "Input").Set(source.SMProxy, source.Port)
    colors.UpdateVTKObjects()
