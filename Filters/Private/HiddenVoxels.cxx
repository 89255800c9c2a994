// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/HiddenVoxels.h"

#include "Base/Error.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace voxplex
{

namespace
{

using Index = std::array<int, 3>;

/** Which points or cells have one of these bits; empty if none has. */
std::vector<char> FindMarked(
  vtkDataSetAttributes* data, vtkIdType count, int bits, const std::string& what)
{
  auto* const ghosts =
    vtkUnsignedCharArray::SafeDownCast(data->GetArray(vtkDataSetAttributes::GhostArrayName()));
  if (ghosts == nullptr)
  {
    return {};
  }
  if (ghosts->GetNumberOfValues() != count)
  {
    throw InputError("The array '" + std::string(vtkDataSetAttributes::GhostArrayName()) +
      "' of the " + what + " has " + std::to_string(ghosts->GetNumberOfValues()) +
      " values; the dimensions ask for " + std::to_string(count) + ".");
  }
  const unsigned char* const first = ghosts->GetPointer(0);
  const auto isMarked = [bits](unsigned char ghost) { return (ghost & bits) != 0; };
  if (std::none_of(first, first + count, isMarked))
  {
    return {};
  }
  std::vector<char> marked(static_cast<std::size_t>(count));
  std::transform(first, first + count, marked.begin(), isMarked);
  return marked;
}

/** The range of indices of the points of a cell, or of the cells around a point, along an axis. */
struct Range
{
  int First;
  int Last;
};

/**
 * Whether all (or any) of the given points or cells beside each of the others are marked.
 * @param n the number of results along each axis
 * @param of the number of `marked` along each axis
 * @param step -1: cells beside points; 1: points of cells
 */
std::vector<char> Spread(
  const std::vector<char>& marked, const Index& n, const Index& of, int step, bool all)
{
  const auto beside = [&](int i, std::size_t axis)
  {
    return Range{ std::max(std::min(i, i + step), 0),
      std::min(std::max(i, i + step), of[axis] - 1) };
  };
  std::vector<char> result;
  result.reserve(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) *
    static_cast<std::size_t>(n[2]));
  for (int k = 0; k < n[2]; ++k)
  {
    for (int j = 0; j < n[1]; ++j)
    {
      for (int i = 0; i < n[0]; ++i)
      {
        const Range x = beside(i, 0);
        const Range y = beside(j, 1);
        const Range z = beside(k, 2);
        bool found = all;
        for (int c = z.First; c <= z.Last; ++c)
        {
          for (int b = y.First; b <= y.Last; ++b)
          {
            const std::size_t row = (static_cast<std::size_t>(c) * static_cast<std::size_t>(of[1]) +
                                      static_cast<std::size_t>(b)) *
              static_cast<std::size_t>(of[0]);
            for (int a = x.First; a <= x.Last; ++a)
            {
              const bool is = marked[row + static_cast<std::size_t>(a)] != 0;
              found = all ? found && is : found || is;
            }
          }
        }
        result.push_back(found ? 1 : 0);
      }
    }
  }
  return result;
}

/** Marks in `hidden`, which may be empty, what is marked in `more`. */
void Add(const std::vector<char>& more, std::vector<char>& hidden)
{
  hidden.resize(more.size());
  std::transform(more.begin(), more.end(), hidden.begin(), hidden.begin(),
    [](char a, char b) { return static_cast<char>(a | b); });
}

} // namespace

//----------------------------------------------------------------------------------------------------
std::vector<char> FindHiddenVoxels(vtkImageData* image, bool cells, const std::string& what)
{
  using Attributes = vtkDataSetAttributes;
  const std::vector<char> points =
    FindMarked(image->GetPointData(), image->GetNumberOfPoints(), Attributes::HIDDENPOINT, what);
  const std::vector<char> ofCells = FindMarked(image->GetCellData(), image->GetNumberOfCells(),
    Attributes::HIDDENCELL | Attributes::REFINEDCELL, what);
  Index n;
  image->GetDimensions(n.data());
  Index cellsAlong;
  std::transform(
    n.begin(), n.end(), cellsAlong.begin(), [](int along) { return std::max(along - 1, 1); });
  std::vector<char> hidden = cells ? ofCells : points;
  if (cells && !points.empty())
  {
    Add(Spread(points, cellsAlong, n, 1, false), hidden);
  }
  else if (!cells && !ofCells.empty())
  {
    Add(Spread(ofCells, n, cellsAlong, -1, true), hidden);
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
