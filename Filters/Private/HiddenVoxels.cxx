// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/HiddenVoxels.h"

#include "Base/Error.h"

#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace voxplex
{

namespace
{

using Attributes = vtkDataSetAttributes;
constexpr int HiddenBits = Attributes::HIDDENCELL | Attributes::REFINEDCELL; // of cells

/**
 * Whether a point or cell has one of these bits; the array may be null.
 * @throws InputError unless each of `count` points or cells has a value
 */
bool HasMarked(vtkUnsignedCharArray* ghosts, int bits, vtkIdType count, const std::string& what)
{
  if (ghosts == nullptr)
  {
    return false;
  }
  if (ghosts->GetNumberOfValues() != count)
  {
    throw InputError("The array '" + std::string(Attributes::GhostArrayName()) + "' of the " +
      what + " has " + std::to_string(ghosts->GetNumberOfValues()) +
      " values; the dimensions ask for " + std::to_string(count) + ".");
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
std::vector<char> FindHiddenVoxels(vtkImageData* image, bool cells, const std::string& what)
{
  const bool hasHiddenPoints = HasMarked(
    image->GetPointGhostArray(), Attributes::HIDDENPOINT, image->GetNumberOfPoints(), what);
  const bool hasHiddenCells =
    HasMarked(image->GetCellGhostArray(), HiddenBits, image->GetNumberOfCells(), what);
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

vtkSmartPointer<vtkDataArray> WithoutHidden(
  vtkDataArray* array, const std::vector<char>& hidden, ImageContent content)
{
  int type = array->GetDataType() == VTK_BIT ? VTK_UNSIGNED_CHAR : array->GetDataType();
  double value = 0.0;
  if (content == ImageContent::GreyValues)
  {
    const bool fitsInFloat = type == VTK_FLOAT || array->GetDataTypeSize() <= 2;
    type = fitsInFloat ? VTK_FLOAT : VTK_DOUBLE;
    value = std::numeric_limits<double>::quiet_NaN();
  }
  auto copy = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  copy->DeepCopy(array);
  copy->SetName(array->GetName());
  for (std::size_t i = 0; i < hidden.size(); ++i)
  {
    for (int c = 0; hidden[i] && c < copy->GetNumberOfComponents(); ++c)
    {
      copy->SetComponent(static_cast<vtkIdType>(i), c, value);
    }
  }
  return copy;
}

} // namespace voxplex
