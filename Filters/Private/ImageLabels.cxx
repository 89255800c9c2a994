// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/ImageLabels.h"

#include "Base/Error.h"

#include <cstddef>
#include <span>
#include <string>

namespace voxplex
{

LabelImage<3> ReadLabels(const ChosenArray& input, const LabelSelection& selection,
  unsigned threads, const std::stop_token& stop)
{
  const vtkSmartPointer<vtkDataArray> array = Contiguous(input.Array);
  const auto count = static_cast<std::size_t>(array->GetNumberOfTuples());
  switch (array->GetDataType())
  {
    vtkTemplateMacro(return LabelImage<3>::FromScalars<VTK_TT>(
      std::span<const VTK_TT>(static_cast<const VTK_TT*>(array->GetVoidPointer(0)), count),
      input.Frame.Grid, selection, threads, stop));
  }
  throw InputError(
    "Scalars of type " + std::string(array->GetDataTypeAsString()) + " cannot be read as labels.");
}

} // namespace voxplex
