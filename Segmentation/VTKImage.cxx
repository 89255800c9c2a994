// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VTKImage.h"

#include "ImageVoxels.h"
#include "Placement.h"
#include "Refuse.h"
#include "ShownText.h"
#include "Space.h"

#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTypeTraits.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <unordered_map>
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

// --- And back

/** An array over the image's own buffer, which it keeps alive for as long as it lives itself. */
vtkSmartPointer<vtkDataArray> ShareScalars(const ScalarImage& image, int frame)
{
  const int type =
    Dispatch(image.Type, [](auto zero) { return vtkTypeTraits<decltype(zero)>::VTKTypeID(); });
  const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetName("Labels");
  const std::size_t frameSize =
    image.NumberOfVoxels() * static_cast<std::size_t>(array->GetDataTypeSize());
  array->SetVoidArray(
    static_cast<std::byte*>(image.Scalars.get()) + static_cast<std::size_t>(frame) * frameSize,
    static_cast<vtkIdType>(image.NumberOfVoxels()), 1);

  // The observer dies with the array; its client data is a share of the buffer.
  vtkNew<vtkCallbackCommand> owner;
  owner->SetClientData(new std::shared_ptr<void>(image.Scalars));
  owner->SetClientDataDeleteCallback(
    [](void* share) { delete static_cast<std::shared_ptr<void>*>(share); });
  array->AddObserver(vtkCommand::UserEvent, owner);
  return array;
}

/** Keyed by the scalars' own type: comparing values of different types could take one for another. */
template <typename T>
void KeepSeen(const ScalarImage& image, LabelTable& table)
{
  std::unordered_map<T, std::int64_t> unseen;
  for (const auto& [label, entry] : table.Entries)
  {
    if (Holds<T>(label))
    {
      unseen.emplace(static_cast<T>(label), label);
    }
  }
  LabelTable seen;
  const T* const scalars = static_cast<const T*>(image.Scalars.get());
  const std::size_t count = image.NumberOfVoxels() * static_cast<std::size_t>(image.Frames);
  T last = 0; // the background, and then the previous voxel: they come in runs
  for (std::size_t i = 0; i < count && !unseen.empty(); ++i)
  {
    if (scalars[i] != last)
    {
      last = scalars[i];
      const auto found = unseen.find(last);
      if (found != unseen.end())
      {
        seen.Entries.insert(table.Entries.extract(found->second));
        unseen.erase(found);
      }
    }
  }
  table = std::move(seen);
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

vtkSmartPointer<vtkImageData> ToVTKImage(const ScalarImage& image, Space space, int frame)
{
  const auto result = vtkSmartPointer<vtkImageData>::New();
  result->SetDimensions(image.Dimensions.data());
  result->SetSpacing(image.Spacing.data());
  std::array<double, 3> origin = image.Origin;
  std::array<double, 9> direction = image.Direction;
  const std::array<double, 3> signs = SignsFromLPS(space);
  for (std::size_t row = 0; row < 3; ++row)
  {
    origin[row] *= signs[row];
    for (std::size_t column = 0; column < 3; ++column)
    {
      direction[3 * row + column] *= signs[row];
    }
  }
  result->SetOrigin(origin.data());
  result->SetDirectionMatrix(direction.data());
  result->GetPointData()->SetScalars(ShareScalars(image, frame));
  return result;
}

void FillVTKImage(
  vtkImageData* output, const ScalarImage& image, Space space, const LabelTable& table, int frame)
{
  output->ShallowCopy(ToVTKImage(image, space, frame));
  SetSpace(output->GetFieldData(), space);
  SetLabelTable(output->GetFieldData(), table);
}

void KeepLabelsOf(const ScalarImage& image, LabelTable& table)
{
  Dispatch(image.Type, [&](auto zero) { KeepSeen<decltype(zero)>(image, table); });
}

} // namespace voxplex
