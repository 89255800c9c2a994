# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Progress reaches ParaView, and AbortExecute stops the filter. The button itself is tested in the window."""
from voxplex_testing import *

from paraview.simple import XMLImageDataReader


def main():
    load_plugin(namespace=globals())
    reader = XMLImageDataReader(FileName=[write_image(make_image(two_balls), "balls.vti")])
    mesher = MeshSegmentationTetrahedralize(Input=reader, Delta=0.25, Threads=1)
    algorithm = mesher.SMProxy.GetClientSideObject()
    seen = []

    check(algorithm.HasObserver("ProgressEvent"), "ParaView observes the progress")

    def abort(caller, event):
        seen.append(caller.GetProgress())
        if caller.GetProgress() > 0.2:
            caller.SetAbortExecute(1)

    tag = algorithm.AddObserver("ProgressEvent", abort)
    mesher.UpdatePipeline()
    during = [progress for progress in seen if progress < 1.0]  # the pipeline itself reports 1 at the end
    check(during and 0.2 < during[-1] < 0.9, "progress when it stopped", during[-1:])
    check_equal([count_cells(mesher, port) for port in (0, 1)], [0, 0], "cells after an abort")

    algorithm.RemoveObserver(tag)
    mesher.Delta = 1.0
    mesher.UpdatePipeline()
    check(count_cells(mesher) > 1000, "cells after the next Apply", count_cells(mesher))


run(main)
