// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/ChosenArray.h"

#include "Base/Error.h"
#include "Base/NumberText.h"
#include "ImageVoxels.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

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

/** Throws InputError unless all are finite, and positive if they must be. */
void Check(const Point<3>& vector, bool positive, const std::string& name)
{
  for (const double component : vector)
  {
    if (!std::isfinite(component) || (positive && !(component > 0.0)))
    {
      const auto number = [&vector](std::size_t i) { return NumberText(vector[i]); };
      throw InputError("The " + name + " is (" + number(0) + ", " + number(1) + ", " + number(2) +
        "): each component must be " + (positive ? "positive and finite." : "finite."));
    }
  }
}

/**
 * @param cells whether voxels are the image's cells (then they lie at the cell centres) or its points
 * @throws InputError if the image is empty, the spacing is not positive and finite, the origin or
 * the direction is not finite, or the direction matrix is singular
 */
ImageFrame FrameOf(vtkImageData* image, bool cells, const std::string& what)
{
  Point<3> spacing;
  Point<3> origin;
  image->GetSpacing(spacing.data());
  image->GetOrigin(origin.data());
  Check(spacing, true, "spacing of the " + what);
  Check(origin, false, "origin of the " + what);
  const double* const cosines = image->GetDirectionMatrix()->GetData();
  if (!std::all_of(cosines, cosines + 9, [](double cosine) { return std::isfinite(cosine); }))
  {
    throw InputError("The direction matrix of the " + what + " has elements that are not finite.");
  }
  const VoxelPlaces places = PlacesOf(image, cells);
  if (*std::min_element(places.Dimensions.begin(), places.Dimensions.end()) < 1)
  {
    throw InputError("The " + what + " is empty.");
  }
  return MakeImageFrame(places.Dimensions, places.Steps, places.First, what);
}

std::vector<char> HiddenVoxelsOf(vtkImageData* image, bool cells, const std::string& what)
{
  try
  {
    return FindHiddenVoxels(image, cells);
  }
  catch (const std::length_error& error)
  {
    throw InputError("The " + what + " cannot be used: " + error.what() + ".");
  }
}

/** A copy in which hidden voxels have the label 0, or are NaN. Grey values become real numbers for that. */
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

} // namespace

ChosenArray Choose(vtkImageData* image, vtkAbstractArray* chosen, int association,
  ImageContent content, const std::string& what)
{
  const bool cells = association == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  ChosenArray result;
  result.Array = RequireNumbers(chosen, what);
  result.Frame = FrameOf(image, cells, what);
  const auto& n = result.Frame.Grid.Dimensions;
  if (result.Array->GetNumberOfTuples() != n[0] * n[1] * n[2])
  {
    throw InputError("The array '" + NameOf(chosen) + "' of the " + what + " has " +
      std::to_string(result.Array->GetNumberOfTuples()) + " values; the dimensions ask for " +
      std::to_string(n[0] * n[1] * n[2]) + ".");
  }
  const std::vector<char> hidden = HiddenVoxelsOf(image, cells, what);
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

void AddFrame(const ChosenArray& frame, int component, unsigned threads, FrameSeries& series)
{
  const vtkSmartPointer<vtkDataArray> array = Contiguous(frame.Array);
  const auto stride = static_cast<std::size_t>(array->GetNumberOfComponents());
  switch (array->GetDataType())
  {
    vtkTemplateMacro(series.Add(static_cast<const VTK_TT*>(array->GetVoidPointer(0)) + component,
      stride, frame.Frame, NameOf(frame.Array), threads));
    default:
      throw InputError("Scalars of type " + std::string(array->GetDataTypeAsString()) +
        " cannot be read as " + (series.IsOfLabels() ? "labels." : "grey values."));
  }
}

double FindVoxelVolume(vtkInformation* input)
{
  if (input == nullptr || !input->Has(vtkDataObject::SPACING()))
  {
    return 0.0;
  }
  const double* const spacing = input->Get(vtkDataObject::SPACING());
  double volume = spacing[0] * spacing[1] * spacing[2];
  if (input->Has(vtkDataObject::DIRECTION()))
  {
    volume *= std::abs(vtkMatrix3x3::Determinant(input->Get(vtkDataObject::DIRECTION())));
  }
  return volume > 0.0 && std::isfinite(volume) ? volume : 0.0;
}

} // namespace voxplex
