// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/ChosenArray.h"

#include "Base/Error.h"
#include "Private/HiddenVoxels.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"

namespace voxplex
{

namespace
{

std::string NameOf(vtkAbstractArray* array)
{
  return array->GetName() ? array->GetName() : "";
}

vtkDataArray* RequireNumbers(vtkAbstractArray* chosen, const std::string& what)
{
  if (chosen == nullptr)
  {
    throw InputError("The " + what +
      " has no such array: neither active point nor cell scalars, or not the array named in "
      "SetInputArrayToProcess().");
  }
  vtkDataArray* array = vtkDataArray::SafeDownCast(chosen);
  if (array == nullptr)
  {
    throw InputError(
      "The array '" + NameOf(chosen) + "' of the " + what + " does not hold numbers.");
  }
  return array;
}

} // namespace

ChosenArray Choose(vtkImageData* image, vtkAbstractArray* chosen, int association,
  ImageContent content, const std::string& what)
{
  const bool cells = association == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  ChosenArray result;
  result.Array = RequireNumbers(chosen, what);
  result.Frame = MakeImageFrame(image, cells, what);
  const auto& n = result.Frame.Grid.Dimensions;
  if (result.Array->GetNumberOfTuples() != n[0] * n[1] * n[2])
  {
    throw InputError("The array '" + NameOf(chosen) + "' of the " + what + " has " +
      std::to_string(result.Array->GetNumberOfTuples()) + " values; the dimensions ask for " +
      std::to_string(n[0] * n[1] * n[2]) + ".");
  }
  const std::vector<char> hidden = FindHiddenVoxels(image, cells, what);
  if (!hidden.empty())
  {
    result.Array = WithoutHidden(result.Array, hidden, content);
  }
  return result;
}

ChosenArray ChooseScalars(vtkImageData* image, vtkAbstractArray* chosen, int association,
  ImageContent content, const std::string& what, const std::string& advice)
{
  const int components = RequireNumbers(chosen, what)->GetNumberOfComponents();
  if (components != 1)
  {
    throw InputError("The array '" + NameOf(chosen) + "' of the " + what + " has " +
      std::to_string(components) + " components; one is needed." + advice);
  }
  return Choose(image, chosen, association, content, what);
}

vtkSmartPointer<vtkDataArray> Contiguous(vtkDataArray* array)
{
  if (array->HasStandardMemoryLayout() && array->GetDataType() != VTK_BIT)
  {
    return array;
  }
  const int type = array->GetDataType() == VTK_BIT ? VTK_UNSIGNED_CHAR : array->GetDataType();
  auto copy = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  copy->DeepCopy(array);
  return copy;
}

} // namespace voxplex
