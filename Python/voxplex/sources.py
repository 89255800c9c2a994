# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What mesh() takes for an image, as the input of a meshing filter."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Mapping, Optional, Sequence, Union

import numpy
from numpy.typing import NDArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

from .files import Path, segmentation_reader
from .frames import FrameSource, frame_times
from .images import image_from_array, images_from_array
from .names import label_names

Image = Union[vtkImageData, vtkAlgorithm, NDArray[Any], Path, Sequence[vtkImageData]]
SizeImage = Union[vtkImageData, NDArray[Any]]


class Source:
    """An image or a time series.

    is_series: whether it has time frames. data: the image, or the first frame of a list; None if an
    algorithm makes it. algorithm: what makes it; None for a vtkImageData.
    """

    def __init__(self, image: Image, geometry: Mapping[str, Any], times: Optional[Sequence[float]]) -> None:
        self.data: Optional[vtkImageData] = None
        self.algorithm: Optional[vtkAlgorithm] = None
        self.is_series = False
        self._geometry: Dict[str, Any] = dict(geometry)
        self._times = times
        self._own_times: List[float] = []  # of components, or in place of those of an algorithm
        if isinstance(image, numpy.ndarray):
            self._take_array(image)
            return
        if geometry and not isinstance(image, (str, os.PathLike)):
            raise ValueError(f"{', '.join(geometry)}: only for arrays and files; the image has its own")
        if isinstance(image, vtkImageData):
            self._take_data(image)
        elif isinstance(image, (str, os.PathLike)):
            self._take_algorithm(segmentation_reader(image, **geometry))
        elif isinstance(image, vtkAlgorithm):
            self._take_algorithm(image)
        elif isinstance(image, Sequence) and image and all(isinstance(frame, vtkImageData) for frame in image):
            self._take_frames(image)
        else:
            raise TypeError("image must be a vtkImageData, a NumPy array, a path, a list of vtkImageData (not "
                            f"empty), or a VTK algorithm, not {type(image).__name__}")

    def connect(self, target: Any, port: int = 0) -> None:
        """Makes this the input of a filter."""
        if self.algorithm is not None:
            target.SetInputConnection(port, self.algorithm.GetOutputPort())
        else:
            target.SetInputDataObject(port, self.data)
        for time in self._own_times:
            target.AddFrameTime(time)

    def names(self) -> Dict[int, str]:
        """The names of labels that the image carries."""
        if self.data is not None:
            return label_names(self.data)
        assert self.algorithm is not None
        self.algorithm.Update()
        return label_names(self.algorithm.GetOutputDataObject(0))

    def sizes(self, image: SizeImage) -> vtkImageData:
        """An image of sizes; an array gets the geometry of the image."""
        if isinstance(image, vtkImageData):
            return image
        if self.data is None:
            raise TypeError("size_image must be a vtkImageData where the image is not an array or a vtkImageData")
        shape = tuple(reversed(self.data.GetDimensions()))
        if image.shape != shape:
            raise ValueError(f"size_image has the shape {image.shape}, the image {shape}")
        sizes = image_from_array(image)
        sizes.SetExtent(self.data.GetExtent())
        sizes.SetSpacing(self.data.GetSpacing())
        sizes.SetOrigin(self.data.GetOrigin())
        sizes.SetDirectionMatrix(self.data.GetDirectionMatrix())
        return sizes

    def _take_array(self, array: NDArray[Any]) -> None:
        if array.ndim == 4:
            self._take_frames(images_from_array(array, times=self._times, **self._geometry))
        else:
            self._take_data(image_from_array(array, **self._geometry))

    def _take_data(self, image: vtkImageData) -> None:
        self.data = image
        self._take_components(image)

    def _take_frames(self, frames: Sequence[vtkImageData]) -> None:
        times = frame_times(frames) if self._times is None else [float(time) for time in self._times]
        if len(times) != len(frames):
            raise ValueError(f"there are {len(frames)} frames, and {len(times)} times")
        if len(frames) < 2:
            raise ValueError("a time series needs two frames or more; pass a single image as it is")
        self.data = frames[0]
        self.algorithm = FrameSource(frames, times)
        self.is_series = True

    def _take_algorithm(self, algorithm: vtkAlgorithm) -> None:
        algorithm.UpdateInformation()
        self.algorithm = algorithm
        information = algorithm.GetOutputInformation(0)
        steps: List[float] = []
        if information.Has(Pipeline.TIME_STEPS()):
            steps = list(information.Get(Pipeline.TIME_STEPS()))
        if len(steps) < 2:
            algorithm.Update()
            image = algorithm.GetOutputDataObject(0)
            if isinstance(image, vtkImageData):
                self._take_components(image)
            return
        self.is_series = True
        if self._times is not None:
            self._own_times = _one_for_each_frame(self._times, len(steps))

    def _take_components(self, image: vtkImageData) -> None:
        """Several components are frames if there are times for them: they may as well be colours."""
        components = _components(image)
        if components < 2:
            return
        if self._times is None:
            raise ValueError(f"the image has {components} components in each voxel: if they are time frames, pass "
                             "their times (times=[0, 1, ...]); of colours or vectors, extract one component "
                             "(vtkImageExtractComponents), or make labels of them")
        self.is_series = True
        self._own_times = _one_for_each_frame(self._times, components)


def _components(image: vtkImageData) -> int:
    """Of the array that the filters mesh by default; 0 without one."""
    array = image.GetPointData().GetScalars() or image.GetCellData().GetScalars()
    return int(array.GetNumberOfComponents()) if array is not None else 0


def _one_for_each_frame(times: Sequence[float], count: int) -> List[float]:
    if len(times) != count:
        raise ValueError(f"there are {count} frames, and {len(times)} times")
    return [float(time) for time in times]
