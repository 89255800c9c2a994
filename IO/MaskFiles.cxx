// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MaskFiles.h"

#include "FileError.h"
#include "ImageReading/InputFile.h"
#include "Text.h"
#include "VTKImage.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkImageReslice.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSortFileNames.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <new>
#include <optional>
#include <sstream>
#include <string_view>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

/** How far corners of grids may be apart that are meant to be one, in voxels: some headers have single precision. */
constexpr double Tolerance = 0.01;

// --- Names -------------------------------------------------------------------------------------------

/** Of files in a folder that are masks: those of volumes, the longer first. */
constexpr std::array<std::string_view, 14> Extensions{ ".seg.nrrd", ".nii.gz", ".hdr.gz",
  ".gipl.gz", ".nii", ".nrrd", ".nhdr", ".hdr", ".mha", ".mhd", ".gipl", ".vti", ".vtk", ".mrc" };
/** What these files have their voxels in. */
constexpr std::array<std::string_view, 5> DataExtensions{ ".img", ".img.gz", ".raw", ".raw.gz",
  ".zraw" };

template <std::size_t N>
std::string_view ExtensionOf(const std::string& name, const std::array<std::string_view, N>& list)
{
  const std::string lower = LowerCase(name);
  const auto found = std::find_if(list.begin(), list.end(),
    [&lower](std::string_view end) { return lower.size() > end.size() && lower.ends_with(end); });
  return found == list.end() ? std::string_view() : *found;
}

std::string NameOf(const std::string& path)
{
  const fs::path file = fs::path(path).filename();
  const std::string name = file.string();
  const std::size_t length = ExtensionOf(name, Extensions).size();
  return length > 0 ? name.substr(0, name.size() - length) : file.stem().string();
}

/** Sorted, with the numbers in names as numbers. */
std::vector<std::string> Sorted(const std::vector<std::string>& names)
{
  vtkNew<vtkStringArray> array;
  for (const std::string& name : names)
  {
    array->InsertNextValue(name);
  }
  vtkNew<vtkSortFileNames> sort;
  sort->NumericSortOn();
  sort->SetInputFileNames(array);
  std::vector<std::string> sorted;
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    sorted.push_back(sort->GetFileNames()->GetValue(i));
  }
  return sorted;
}

/** By the four letters that tell it, since nothing of a file is parsed in this process. */
bool IsDICOMFile(const std::string& path)
{
  try
  {
    constexpr std::size_t preamble = 128;
    return InputFile(path).Beginning(preamble + 4).find("DICM", preamble) == preamble;
  }
  catch (const FileError&) // what cannot be opened is no reason to take the folder for one of DICOM
  {
    return false;
  }
}

/** The masks of a folder; none if a file is DICOM, or this is no folder. */
std::vector<std::string> ListMasks(const std::string& folder, std::vector<std::string>& warnings)
{
  std::vector<std::string> masks;
  std::vector<std::string> others;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
  {
    std::error_code failed;
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') || !entry.is_regular_file(failed))
    {
      continue;
    }
    if (!ExtensionOf(name, Extensions).empty())
    {
      masks.push_back(entry.path().string());
    }
    else if (IsDICOMFile(entry.path().string()))
    {
      return {};
    }
    else if (ExtensionOf(name, DataExtensions).empty())
    {
      others.push_back(Excerpt(name));
    }
  }
  std::string text;
  for (const std::string& name : Sorted(others))
  {
    text += (text.empty() ? "" : ", ") + name;
  }
  if (!masks.empty() && !text.empty())
  {
    warnings.push_back(folder + ": left out what is no image: " + text);
  }
  return Sorted(masks);
}

// --- Grids -------------------------------------------------------------------------------------------

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
std::uint64_t CountBeyond(const ScalarImage& mask, const ScalarImage& grid)
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
            if (IsInside(*voxel))
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

// --- Reading -----------------------------------------------------------------------------------------

/** Warnings that many files have in common are said once. */
class FileWarnings
{
public:
  void Add(const std::string& path, const std::vector<std::string>& warnings)
  {
    for (const std::string& warning : warnings)
    {
      const std::string text =
        warning.starts_with(path + ": ") ? warning.substr(path.size() + 2) : warning;
      const auto same = std::find_if(this->All.begin(), this->All.end(),
        [&text](const Said& said) { return said.Text == text; });
      if (same == this->All.end())
      {
        this->All.push_back({ path, text, 0 });
      }
      else
      {
        ++same->Others;
      }
    }
  }

  std::vector<std::string> Lines() const
  {
    std::vector<std::string> lines;
    for (const Said& said : this->All)
    {
      lines.push_back(said.Path +
        (said.Others > 0 ? " and " + std::to_string(said.Others) + " more" : "") + ": " +
        said.Text);
    }
    return lines;
  }

private:
  struct Said
  {
    std::string Path;
    std::string Text;
    int Others;
  };
  std::vector<Said> All;
};

ImageAnswer ReadMask(const std::string& path, ImageRequest request)
{
  request.Path = path;
  ImageAnswer answer = ReadImage(request);
  const std::string start = "'" + path + "' is no mask, as each of several files must be: it has ";
  RefuseIf(answer.Image.Frames > 1, start, answer.Image.Frames,
    " time frames, and a mask has three dimensions: give it alone");
  RefuseIf(std::count(answer.Image.Dimensions.begin(), answer.Image.Dimensions.end(), 1) > 0, start,
    "one slice, and a mask is a volume: save the slices as one volume, or give a folder of DICOM");
  return answer;
}

struct MaskGrid
{
  ScalarImage Image; ///< without voxels
  std::string Path;
};

MaskGrid FinestGrid(const std::vector<std::string>& paths, const ImageRequest& request)
{
  MaskGrid finest;
  for (const std::string& path : paths)
  {
    ScalarImage image = ReadMask(path, request).Image;
    if (finest.Path.empty() || VoxelVolume(image) < VoxelVolume(finest.Image))
    {
      image.Scalars.reset();
      finest = { std::move(image), path };
    }
  }
  return finest;
}

/** One label image of several masks. */
class MaskReading
{
public:
  MaskReading(MaskGrid grid, bool resample)
    : Grid(std::move(grid))
    , MayResample(resample)
    , Union(
        this->Grid.Image,
        [](std::size_t bytes)
        {
          const std::shared_ptr<std::byte[]> memory(new std::byte[bytes]);
          return std::shared_ptr<void>(memory, memory.get());
        },
        "masks")
  {
  }

  void Add(const std::string& path, ImageAnswer answer)
  {
    this->Warnings.Add(path, answer.Warnings);
    this->Resample(path, answer.Image);
    this->Labels.Entries[this->Union.AddName(NameOf(path))] = { NameOf(path), std::nullopt };
    try
    {
      this->Union.AddMask(answer.Image);
    }
    catch (const FileError& error)
    {
      Refuse("'", path, "' is no mask, as each of several files must be: ", error.what());
    }
  }

  ImageAnswer Finish(Overlap rule)
  {
    ImageAnswer answer;
    answer.Warnings = this->Warnings.Lines();
    if (!this->Lost.empty())
    {
      answer.Warnings.push_back("masks reach beyond the finest grid, that of '" + this->Grid.Path +
        "', and lose voxels there: " + this->Lost);
    }
    answer.Image = this->Union.Finish(rule, answer.Warnings);
    answer.Labels = std::move(this->Labels);
    LeaveOutOtherTexts(answer.Labels, answer.Warnings);
    return answer;
  }

private:
  /** Unless the mask is on the grid. */
  void Resample(const std::string& path, ScalarImage& mask)
  {
    const auto difference = Difference(this->Grid.Image, mask);
    if (!difference)
    {
      return;
    }
    const auto& [what, first, second] = *difference;
    RefuseIf(!this->MayResample, "masks must be on one grid, but '", this->Grid.Path, "' has the ",
      what, ' ', first, ", and '", path, "' ", second,
      "; give ResampleMasksOn() to resample them to the finest grid, by nearest neighbour");
    if (const std::uint64_t lost = CountBeyond(mask, this->Grid.Image))
    {
      this->Lost +=
        (this->Lost.empty() ? "" : ", ") + Excerpt(NameOf(path)) + " " + std::to_string(lost);
    }
    mask = io::Resample(mask, this->Grid.Image);
  }

  MaskGrid Grid;
  bool MayResample;
  MaskUnion Union;
  LabelTable Labels;
  FileWarnings Warnings;
  std::string Lost;
};

ImageAnswer ReadMasks(
  const std::vector<std::string>& paths, const ImageRequest& request, bool resample)
{
  std::optional<MaskReading> reading;
  if (resample)
  {
    reading.emplace(FinestGrid(paths, request), true);
  }
  for (const std::string& path : paths)
  {
    ImageAnswer answer = ReadMask(path, request);
    if (!reading)
    {
      MaskGrid grid{ answer.Image, path };
      grid.Image.Scalars.reset();
      reading.emplace(std::move(grid), false);
    }
    reading->Add(path, std::move(answer));
  }
  return reading->Finish(request.Rule);
}

} // namespace

ImageAnswer ReadImageOrMasks(
  const std::vector<std::string>& paths, const ImageRequest& request, bool resample)
{
  std::vector<std::string> warnings;
  std::vector<std::string> masks = paths;
  if (paths.size() == 1)
  {
    masks =
      request.Series.empty() ? ListMasks(paths.front(), warnings) : std::vector<std::string>();
  }
  if (masks.empty())
  {
    ImageRequest one = request;
    one.Path = paths.front();
    return ReadImage(one);
  }
  try
  {
    ImageAnswer answer = ReadMasks(masks, request, resample);
    answer.Warnings.insert(answer.Warnings.begin(), warnings.begin(), warnings.end());
    return answer;
  }
  catch (const std::bad_alloc&)
  {
    Refuse("cannot read '", paths.front(), "' and the other masks: they do not fit into memory");
  }
}

} // namespace voxplex::io
