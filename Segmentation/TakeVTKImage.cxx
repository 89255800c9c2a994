// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VTKImage.h"

#include "ImageVoxels.h"
#include "Placement.h"
#include "Refuse.h"
#include "ShownText.h"
#include "Space.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace voxplex
{
namespace
{

// --- Which array

struct Labels
{
  vtkDataArray* Array = nullptr;
  bool AreCells = false;
};

bool IsCandidate(vtkDataSetAttributes* data, int index)
{
  vtkDataArray* const array = data->GetArray(index); // null for texts
  const bool isOtherAttribute = data->IsArrayAnAttribute(index) >= 0 && array != data->GetScalars();
  return array && array->GetNumberOfComponents() == 1 && !isOtherAttribute &&
    (!array->GetName() || std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()));
}

std::string NameOf(const Labels& labels)
{
  const char* name = labels.Array->GetName();
  return "'" + Excerpt(name ? name : "") + "' of the " + (labels.AreCells ? "cells" : "points");
}

void CheckComponents(vtkDataSetAttributes* data)
{
  vtkDataArray* const scalars = data->GetScalars();
  const int components = scalars ? scalars->GetNumberOfComponents() : 1;
  RefuseIf(components != 1, "it has ", components,
    " components a voxel (colours or vectors); a label image has one: export it as a label map "
    "first");
}

Labels ChooseLabels(vtkImageData* image)
{
  std::vector<Labels> active;
  std::vector<Labels> candidates;
  for (const bool areCells : { false, true })
  {
    vtkDataSetAttributes* const data = areCells
      ? static_cast<vtkDataSetAttributes*>(image->GetCellData())
      : static_cast<vtkDataSetAttributes*>(image->GetPointData());
    CheckComponents(data);
    for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    {
      if (IsCandidate(data, i))
      {
        candidates.push_back({ data->GetArray(i), areCells });
      }
    }
    if (data->GetScalars())
    {
      active.push_back({ data->GetScalars(), areCells });
    }
  }
  const std::vector<Labels>& choice = active.empty() ? candidates : active;
  RefuseIf(choice.empty(), "it has no array of numbers with one component for its points or cells");
  if (choice.size() > 1)
  {
    std::string names;
    for (const Labels& labels : choice)
    {
      names += (names.empty() ? "" : ", ") + NameOf(labels);
    }
    Refuse("it has several arrays that could be labels (", names,
      "): make one of them the active scalars, or save it alone");
  }
  return choice.front();
}

// --- The image

/** A bit becomes a byte. */
ScalarType ScalarTypeOf(vtkDataArray* array)
{
  switch (array->GetDataType())
  {
    case VTK_BIT:
      return ScalarType::UInt8;
    case VTK_FLOAT:
      return ScalarType::Float32;
    case VTK_DOUBLE:
      return ScalarType::Float64;
    default:
      break;
  }
  const bool isSigned = array->GetDataTypeMin() < 0;
  const auto type = IntegerType(static_cast<std::size_t>(array->GetDataTypeSize()), isSigned);
  RefuseIf(!type, "its numbers are of the type ", Excerpt(array->GetDataTypeAsString()),
    ", which voxplex does not read");
  return *type;
}

/** Where labels lie, without their voxels. */
ScalarImage PlaceOf(vtkImageData* image, const Labels& labels)
{
  ScalarImage result;
  result.Type = ScalarTypeOf(labels.Array);
  for (int axis = 0; axis < 3; ++axis)
  {
    RefuseIf(!(image->GetSpacing()[axis] > 0), "the voxel spacing along axis ", axis,
      " is not positive in its header: correct the header");
  }
  VoxelPlaces places = PlacesOf(image, labels.AreCells);
  const auto toLPS = [signs = SignsFromLPS(GetSpace(image->GetFieldData()))](Vector3& vector)
  {
    std::transform(signs.begin(), signs.end(), vector.begin(), vector.begin(), std::multiplies<>());
  };
  std::for_each(places.Steps.begin(), places.Steps.end(), toLPS);
  toLPS(places.First);
  SetSizes(result, { places.Dimensions.begin(), places.Dimensions.end() });
  Place(result, places.Steps, places.First);
  return result;
}

} // namespace

ScalarImage PlaceOfVTKImage(vtkImageData* image)
{
  return PlaceOf(image, ChooseLabels(image));
}

ScalarImage TakeVTKImage(vtkImageData* image, const VoxelAllocator& allocate, LabelTable& table,
  std::vector<std::string>& warnings)
{
  const Labels labels = ChooseLabels(image);
  ScalarImage result = PlaceOf(image, labels);
  std::optional<std::string> unknown;
  GetSpace(image->GetFieldData(), &unknown);
  if (unknown)
  {
    warnings.push_back("it does not say where left, posterior and superior are (SPACE is '" +
      Excerpt(*unknown) + "'); its coordinates are taken for LPS");
  }
  table = GetLabelTable(image->GetFieldData());
  LeaveOutOtherTexts(table, warnings);
  const auto count = static_cast<vtkIdType>(result.NumberOfVoxels());
  RefuseIf(labels.Array->GetNumberOfTuples() != count, "it is truncated or damaged: its array ",
    NameOf(labels), " has ", labels.Array->GetNumberOfTuples(), " numbers of ", count);
  const std::size_t size = SizeOf(result.Type);
  result.Scalars = allocate(result.NumberOfVoxels() * size);
  auto* const numbers = static_cast<std::byte*>(result.Scalars.get());
  std::memcpy(numbers, Contiguous(labels.Array)->GetVoidPointer(0), result.NumberOfVoxels() * size);
  const std::vector<char> hidden = FindHiddenVoxels(image, labels.AreCells);
  for (std::size_t voxel = 0; voxel < hidden.size(); ++voxel)
  {
    if (hidden[voxel])
    {
      std::memset(numbers + voxel * size, 0, size);
    }
  }
  return result;
}

} // namespace voxplex
