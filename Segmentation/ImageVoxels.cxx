// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageVoxels.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace voxplex
{

namespace
{

using Attributes = vtkDataSetAttributes;
constexpr int HiddenBits = Attributes::HIDDENCELL | Attributes::REFINEDCELL; // of cells

/**
 * Whether a point or cell has one of these bits; the array may be null.
 * @throws std::length_error unless each of `count` points or cells has a value
 */
bool HasMarked(vtkUnsignedCharArray* ghosts, int bits, vtkIdType count)
{
  if (ghosts == nullptr)
  {
    return false;
  }
  if (ghosts->GetNumberOfValues() != count)
  {
    throw std::length_error("the array '" + std::string(Attributes::GhostArrayName()) + "' has " +
      std::to_string(ghosts->GetNumberOfValues()) + " values; the dimensions ask for " +
      std::to_string(count));
  }
  const unsigned char* const first = ghosts->GetPointer(0);
  return std::any_of(
    first, first + count, [bits](unsigned char ghost) { return (ghost & bits) != 0; });
}

/** Whether there are cells around a point, and all are hidden themselves. */
bool IsAmongHiddenCells(vtkImageData* image, vtkIdType point, vtkIdList* cells)
{
  vtkUnsignedCharArray* const ghosts = image->GetCellGhostArray();
  image->GetPointCells(point, cells);
  bool isHidden = cells->GetNumberOfIds() > 0;
  for (vtkIdType i = 0; i < cells->GetNumberOfIds(); ++i)
  {
    isHidden = isHidden && (ghosts->GetValue(cells->GetId(i)) & HiddenBits) != 0;
  }
  return isHidden;
}

} // namespace

//----------------------------------------------------------------------------------------------------
VoxelPlaces PlacesOf(vtkImageData* image, bool cells)
{
  VoxelPlaces places;
  std::array<double, 3> first;
  const int* const extent = image->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto a = static_cast<std::size_t>(axis);
    const std::int64_t points = std::int64_t{ extent[2 * axis + 1] } - extent[2 * axis] + 1;
    const bool isBetween = cells && points > 1;
    places.Dimensions[a] = isBetween ? points - 1 : points;
    first[a] = extent[2 * axis] + (isBetween ? 0.5 : 0.0);
    for (int row = 0; row < 3; ++row)
    {
      places.Steps[a][static_cast<std::size_t>(row)] =
        image->GetDirectionMatrix()->GetElement(row, axis) * image->GetSpacing()[axis];
    }
  }
  image->TransformContinuousIndexToPhysicalPoint(first.data(), places.First.data());
  return places;
}

std::vector<char> FindHiddenVoxels(vtkImageData* image, bool cells)
{
  const bool hasHiddenPoints =
    HasMarked(image->GetPointGhostArray(), Attributes::HIDDENPOINT, image->GetNumberOfPoints());
  const bool hasHiddenCells =
    HasMarked(image->GetCellGhostArray(), HiddenBits, image->GetNumberOfCells());
  if (!hasHiddenPoints && !hasHiddenCells)
  {
    return {};
  }
  std::vector<char> hidden;
  vtkNew<vtkIdList> around;
  const vtkIdType count = cells ? image->GetNumberOfCells() : image->GetNumberOfPoints();
  for (vtkIdType voxel = 0; voxel < count; ++voxel)
  {
    const bool isHidden = cells ? !image->IsCellVisible(voxel)
                                : !image->IsPointVisible(voxel) ||
        (hasHiddenCells && IsAmongHiddenCells(image, voxel, around));
    hidden.push_back(isHidden ? 1 : 0);
  }
  return hidden;
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
