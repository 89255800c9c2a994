# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The time slider plays a space-time mesh: it is made once, and its slice follows the time."""

from voxplex_testing import *

from paraview.simple import GetAnimationScene, PVDReader
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

FRAMES = 8


def ball_of(frame):
    """A ball of label 3 whose radius grows from frame to frame."""
    radius = 3.0 + 0.35 * frame
    return lambda i, j, k: 3 if (i - 7.5) ** 2 + (j - 7.5) ** 2 + (k - 7.5) ** 2 < radius * radius else 0


def voxels_at(time):
    """The number of the ball's voxels, of 1 x 1 x 1, linear between frames. Small digital balls are not like spheres."""
    counts = [sum(ball_of(frame)(i, j, k) != 0 for i in range(16) for j in range(16) for k in range(16))
              for frame in range(FRAMES)]
    frame = min(int(time / 0.5), FRAMES - 2)
    return counts[frame] + (time / 0.5 - frame) * (counts[frame + 1] - counts[frame])


def write_series():
    """Times 0, 0.5, 1, ..."""
    lines = []
    for frame in range(FRAMES):
        ball = ball_of(frame)
        name = "growing_%d.vti" % frame
        write_image(make_image(ball), name)
        lines.append('<DataSet timestep="%g" part="0" file="%s"/>' % (0.5 * frame, name))
    path = output_path("growing.pvd")
    with open(path, "w", encoding="ascii") as file:
        file.write('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n%s\n'
                   "</Collection></VTKFile>\n" % "\n".join(lines))
    return path


def volume_of(data):
    sizes = vtkCellSizeFilter()
    sizes.SetInputDataObject(data)
    sizes.Update()
    array = sizes.GetOutput().GetCellData().GetArray("Volume")
    return sum(array.GetValue(i) for i in range(array.GetNumberOfTuples()))


def main():
    load_plugin(namespace=globals())
    series = PVDReader(FileName=write_series())
    series.UpdatePipeline()
    mesher = MeshSegmentationSeriesSpaceTime(Input=series, TimeScale=2.0, Threads=1)
    # Twice the edge of a hypercube as large as 1 x 1 x 1 x (0.5 * 2).
    check(abs(mesher.Delta - 2.0) < 1e-9, "default Delta", mesher.Delta)
    meshings = Executions(mesher)
    check_equal([mesher.SMProxy.GetOutputPortName(i) for i in (0, 1)], ["Mesh", "Boundary"])
    check_equal(mesher.SMProxy.GetClientSideObject().GetExecutive().GetClassName(), "vtkPVFrameGatheringPipeline")
    at = SpaceTimeMeshSlice(Input=mesher)
    boundary = SpaceTimeMeshSlice(Input=mesher[1])

    view = GetActiveViewOrCreate("RenderView")
    Show(mesher, view)
    Show(at, view)
    Show(boundary, view)
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    Render(view)
    check_equal(meshings.count, 1, "executions at the first picture")
    at.UpdatePipelineInformation()
    times = list(at.GetProperty("TimeRange") or [])
    check(len(times) == 2 and abs(times[0]) < 1e-12 and abs(times[1] - 3.5) < 1e-12, "TimeRange", times)

    # Every frame, and times between them: the ball's volume follows, the mesh is not made again.
    volumes = []
    for time in [0.5 * frame for frame in range(FRAMES)] + [0.3, 1.77, 3.2]:
        scene.AnimationTime = time
        Render(view)
        data = servermanager.Fetch(at)
        check(data.GetNumberOfCells() > 10, "cells at", time, data.GetNumberOfCells())
        expected = voxels_at(time)
        volumes.append(volume_of(data))
        check(abs(volumes[-1] / expected - 1.0) < 0.12, "volume at", time, volumes[-1], "expected", expected)
        check(servermanager.Fetch(boundary).GetNumberOfCells() > 10, "boundary at", time)
    check_equal(meshings.count, 1, "executions after playing")
    check(volumes[FRAMES - 1] > 4 * volumes[0], "the ball grows", volumes)

    scene.Play()
    check_equal(meshings.count, 1, "executions after Play()")
    scene.GoToFirst()

    mesher.Delta = 2.5
    Render(view)
    check_equal(meshings.count, 2, "executions after a change")
    scene.AnimationTime = 2.0
    Render(view)
    check_equal(meshings.count, 2, "executions after a change and a step")
    SaveScreenshot(output_path("slice.png"), view)
    check_picture(output_path("slice.png"))

    # The frames as components of one image, in the built-in pipeline.
    from paraview.simple import XMLImageDataReader

    moving = make_image(lambda i, j, k: tuple(
        3 if (i - 5 - 2 * f) ** 2 + (j - 7.5) ** 2 + (k - 7.5) ** 2 < 16 else 0 for f in range(4)), components=4)
    components = XMLImageDataReader(FileName=[write_image(moving, "components.vti")])
    components.UpdatePipeline()
    mesher = MeshSegmentationSeriesSpaceTime(Input=components, TimeBetweenFrames=0.25, FirstTime=1.0, TimeScale=8.0)
    at = SpaceTimeMeshSlice(Input=mesher)
    at.UpdatePipeline(1.5)
    at.UpdatePipelineInformation()
    check_equal(list(at.GetProperty("TimeRange") or []), [1.0, 1.75], "TimeRange")
    check(at.GetDataInformation().GetNumberOfCells() > 10, "components")


run(main)
