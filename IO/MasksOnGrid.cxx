// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MasksOnGrid.h"

#include "FileError.h"
#include "Space.h"
#include "Text.h"
#include "VTKImage.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkImageReslice.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <sstream>

namespace voxplex::io
{
namespace
{

/** How far corners of grids may be apart that are meant to be one, in voxels: some headers have single precision. */
constexpr double Tolerance = 0.01;

/** From indices to places. */
void GetMatrix(const ScalarImage& image, vtkMatrix4x4* matrix)
{
  matrix->Identity();
  for (int row = 0; row < 3; ++row)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto a = static_cast<std::size_t>(axis);
      matrix->SetElement(
        row, axis, image.Direction[3 * static_cast<std::size_t>(row) + a] * image.Spacing[a]);
    }
    matrix->SetElement(row, 3, image.Origin[static_cast<std::size_t>(row)]);
  }
}

/** From indices of one grid to those of another. */
vtkSmartPointer<vtkMatrix4x4> MatrixBetween(const ScalarImage& from, const ScalarImage& to)
{
  vtkNew<vtkMatrix4x4> places;
  const auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  GetMatrix(from, places);
  GetMatrix(to, matrix);
  matrix->Invert();
  vtkMatrix4x4::Multiply4x4(matrix, places, matrix);
  return matrix;
}

std::string Listed(const auto& numbers)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    text << (i > 0 ? " " : "") << numbers[i];
  }
  return text.str();
}

/** "spacing", that of a, that of b: the first that differs. Nothing if all corners are at the same places. */
std::optional<std::array<std::string, 3>> Difference(const ScalarImage& a, const ScalarImage& b)
{
  const auto differs = [](const auto& these, const auto& those, double tolerance)
  {
    for (std::size_t i = 0; i < these.size(); ++i)
    {
      if (!(std::abs(these[i] - those[i]) <= tolerance))
      {
        return true;
      }
    }
    return false;
  };
  using Texts = std::array<std::string, 3>;
  if (a.Dimensions != b.Dimensions)
  {
    return Texts{ "sizes", Listed(a.Dimensions), Listed(b.Dimensions) };
  }
  const vtkSmartPointer<vtkMatrix4x4> matrix = MatrixBetween(b, a);
  bool isSame = true;
  for (int corner = 0; corner < 8; ++corner)
  {
    std::array<double, 4> from{ 0, 0, 0, 1 };
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      from[axis] = (corner >> axis & 1) * (b.Dimensions[axis] - 1);
    }
    std::array<double, 4> to;
    matrix->MultiplyPoint(from.data(), to.data());
    isSame = isSame && !differs(from, to, Tolerance);
  }
  if (isSame)
  {
    return std::nullopt;
  }
  const double smallest = *std::min_element(a.Spacing.begin(), a.Spacing.end());
  const double steps = *std::max_element(a.Dimensions.begin(), a.Dimensions.end());
  if (differs(a.Spacing, b.Spacing, Tolerance * smallest / steps))
  {
    return Texts{ "spacing", Listed(a.Spacing), Listed(b.Spacing) };
  }
  return differs(a.Direction, b.Direction, Tolerance / steps)
    ? Texts{ "direction", Listed(a.Direction), Listed(b.Direction) }
    : Texts{ "origin", Listed(a.Origin), Listed(b.Origin) };
}

double VoxelVolume(const ScalarImage& image)
{
  return image.Spacing[0] * image.Spacing[1] * image.Spacing[2] *
    std::abs(vtkMatrix3x3::Determinant(image.Direction.data()));
}

/** Voxels of a mask whose centres are in no voxel of a grid. */
std::uint64_t CountBeyond(const ScalarImage& mask, const ScalarImage& grid, double threshold)
{
  const vtkSmartPointer<vtkMatrix4x4> matrix = MatrixBetween(mask, grid);
  return Dispatch(mask.Type,
    [&](auto zero)
    {
      using T = decltype(zero);
      const T* voxel = static_cast<const T*>(mask.Scalars.get());
      std::uint64_t count = 0;
      std::array<double, 4> index{ 0, 0, 0, 1 };
      for (int k = 0; k < mask.Dimensions[2]; ++k)
      {
        for (int j = 0; j < mask.Dimensions[1]; ++j)
        {
          for (int i = 0; i < mask.Dimensions[0]; ++i, ++voxel)
          {
            if (IsInside(*voxel, threshold))
            {
              index = { static_cast<double>(i), static_cast<double>(j), static_cast<double>(k), 1 };
              matrix->MultiplyPoint(index.data(), index.data());
              bool isBeyond = false;
              for (std::size_t axis = 0; axis < 3; ++axis)
              {
                isBeyond =
                  isBeyond || index[axis] < -0.5 || index[axis] > grid.Dimensions[axis] - 0.5;
              }
              count += isBeyond;
            }
          }
        }
      }
      return count;
    });
}

/** Nearest neighbours at the voxels of a grid, 0 beyond the mask. */
ScalarImage Resample(const ScalarImage& mask, const ScalarImage& grid)
{
  const vtkSmartPointer<vtkImageData> input = ToVTKImage(mask, Space::LPS);
  input->SetOrigin(0, 0, 0); // vtkImageReslice knows no directions: all is in indices
  input->SetSpacing(1, 1, 1);
  input->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  vtkNew<vtkImageReslice> reslice;
  reslice->SetInputData(input);
  reslice->SetResliceAxes(MatrixBetween(grid, mask));
  reslice->SetInterpolationModeToNearestNeighbor();
  reslice->SetOutputOrigin(0, 0, 0);
  reslice->SetOutputSpacing(1, 1, 1);
  reslice->SetOutputExtent(
    0, grid.Dimensions[0] - 1, 0, grid.Dimensions[1] - 1, 0, grid.Dimensions[2] - 1);
  reslice->Update();
  vtkSmartPointer<vtkDataArray> voxels = reslice->GetOutput()->GetPointData()->GetScalars();
  ScalarImage result = grid;
  result.Type = mask.Type;
  result.Scalars = { voxels->GetVoidPointer(0), [voxels](void*) {} };
  return result;
}

void CheckIsMask(const ScalarImage& image, const std::string& shown)
{
  const std::string start = shown + " is no mask, as each of several must be: it has ";
  RefuseIf(image.Frames > 1, start, image.Frames,
    " time frames, and a mask has three dimensions: give it alone");
  RefuseIf(std::count(image.Dimensions.begin(), image.Dimensions.end(), 1) > 0, start,
    "one slice, and a mask is a volume: save the slices as one volume, or give a folder of DICOM");
}

std::shared_ptr<void> Allocate(std::size_t bytes)
{
  const std::shared_ptr<std::byte[]> memory(new std::byte[bytes]);
  return { memory, memory.get() };
}

} // namespace

void MasksOnGrid::OfferGrid(ScalarImage image, const std::string& shown)
{
  CheckIsMask(image, shown);
  this->MayResample = true;
  if (this->ShownOfGrid.empty() || VoxelVolume(image) < VoxelVolume(this->Grid))
  {
    this->Grid = std::move(image);
    this->Grid.Scalars.reset();
    this->ShownOfGrid = shown;
  }
}

void MasksOnGrid::Add(const LabelTable::Entry& entry, ScalarImage image, const std::string& shown)
{
  CheckIsMask(image, shown);
  if (this->ShownOfGrid.empty())
  {
    this->Grid = image;
    this->Grid.Scalars.reset();
    this->ShownOfGrid = shown;
  }
  if (!this->Union)
  {
    this->Union.emplace(this->Grid, Allocate, "masks");
  }
  const std::string name = entry.Name.empty() ? shown : entry.Name;
  this->Resample(name, image, shown);
  const std::uint32_t label = this->Union->AddName(name);
  if (!entry.Name.empty())
  {
    this->Labels.Entries[label] = entry;
  }
  try
  {
    this->Union->AddMask(image, this->Threshold);
  }
  catch (const FileError& error)
  {
    Refuse(shown, " is no mask, as each of several must be: ", error.what());
  }
}

/** Unless the mask is on the grid. */
void MasksOnGrid::Resample(const std::string& name, ScalarImage& image, const std::string& shown)
{
  const auto difference = Difference(this->Grid, image);
  if (!difference)
  {
    return;
  }
  const auto& [what, first, second] = *difference;
  RefuseIf(!this->MayResample, "masks must be on one grid, but ", this->ShownOfGrid, " has the ",
    what, ' ', first, ", and ", shown, ' ', second,
    "; give ResampleMasksOn() to resample them to the finest grid, by nearest neighbour");
  if (const std::uint64_t lost = CountBeyond(image, this->Grid, this->Threshold))
  {
    this->Lost += (this->Lost.empty() ? "" : ", ") + Excerpt(name) + " " + std::to_string(lost);
  }
  image = io::Resample(image, this->Grid);
}

ImageAnswer MasksOnGrid::Finish(Overlap rule, std::vector<std::string> warnings)
{
  ImageAnswer answer;
  answer.Warnings = std::move(warnings);
  if (!this->Lost.empty())
  {
    answer.Warnings.push_back("masks reach beyond the finest grid, that of " + this->ShownOfGrid +
      ", and lose voxels there: " + this->Lost);
  }
  answer.Image = this->Union->Finish(rule, answer.Warnings);
  answer.Labels = std::move(this->Labels);
  LeaveOutOtherTexts(answer.Labels, answer.Warnings);
  return answer;
}

} // namespace voxplex::io
