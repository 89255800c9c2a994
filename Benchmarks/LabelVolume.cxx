// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelVolume.h"

#include <itkImage.h>
#include <itkImageFileReader.h>

namespace voxplex::benchmarks
{

LabelVolume ReadLabelVolume(const std::string& fileName)
{
  using Image = itk::Image<std::uint16_t, 3>;
  const auto reader = itk::ImageFileReader<Image>::New();
  reader->SetFileName(fileName);
  reader->Update();
  const Image& image = *reader->GetOutput();

  LabelVolume volume;
  const auto size = image.GetLargestPossibleRegion().GetSize();
  for (unsigned axis = 0; axis < 3; ++axis)
  {
    volume.Dimensions[axis] = static_cast<std::int64_t>(size[axis]);
    volume.Spacing[axis] = image.GetSpacing()[axis];
  }
  const std::uint16_t* const first = image.GetBufferPointer();
  volume.Labels.assign(first, first + image.GetLargestPossibleRegion().GetNumberOfPixels());
  return volume;
}

} // namespace voxplex::benchmarks
