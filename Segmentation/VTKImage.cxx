// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VTKImage.h"

#include <vtkCallbackCommand.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkTypeTraits.h>

#include <cstddef>
#include <unordered_map>

namespace voxplex
{
namespace
{

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
