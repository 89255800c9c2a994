// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "FilesOfFolder.h"
#include "Placement.h"
#include "Text.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <optional>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

std::string NameInFolder(const std::string& path)
{
  return "'" + Excerpt(fs::path(path).filename().string()) + "'";
}

/** The last number in a name, by which slices are counted. */
std::optional<std::int64_t> NumberOf(const std::string& path)
{
  constexpr const char* digits = "0123456789";
  const std::string stem = fs::path(path).stem().string();
  const std::size_t last = stem.find_last_of(digits);
  const std::size_t before = last == stem.npos ? last : stem.find_last_not_of(digits, last);
  return last == stem.npos
    ? std::nullopt
    : ToNumber<std::int64_t>(std::string_view(stem).substr(before + 1, last - before));
}

/** If names have numbers, their steps are one. */
void CheckNumbers(const std::vector<std::string>& files)
{
  std::optional<std::int64_t> step;
  for (std::size_t i = 1; i < files.size(); ++i)
  {
    const auto first = NumberOf(files[i - 1]);
    const auto second = NumberOf(files[i]);
    if (!first || !second)
    {
      return;
    }
    step = step ? std::min(*step, *second - *first) : *second - *first;
  }
  for (std::size_t i = 1; i < files.size(); ++i)
  {
    const std::int64_t apart = *NumberOf(files[i]) - *NumberOf(files[i - 1]);
    RefuseIf(apart != *step, "slices are missing, or numbered twice: ", NameInFolder(files[i]),
      " follows ", NameInFolder(files[i - 1]), ", and other numbers are ", *step,
      " apart: complete the folder, or number its files without gaps");
  }
}

ScalarImage ReadSlice(const std::string& path, Reading& reading)
{
  try
  {
    return IsPNG(InputFile(path)) ? ReadPNGSlice(path, reading) : ReadTIFFSlice(path, reading);
  }
  catch (const FileError& error)
  {
    Refuse(NameInFolder(path), ": ", error.what());
  }
}

} // namespace

std::vector<std::string> ListSlices(const std::string& folder)
{
  std::vector<std::string> slices;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
  {
    std::error_code failed;
    const std::string extension = LowerCase(entry.path().extension().string());
    if (!entry.is_regular_file(failed) || entry.path().filename().string().starts_with('.'))
    {
      continue;
    }
    if (extension == ".tif" || extension == ".tiff" || extension == ".png")
    {
      slices.push_back(entry.path().string());
    }
    else if (IsDICOMFile(entry.path().string()))
    {
      return {};
    }
  }
  return SortByNumbers(slices);
}

ScalarImage ReadSlices(const std::vector<std::string>& files, Reading& reading)
{
  RefuseIf(files.size() == 1, "it holds one slice, ", NameInFolder(files[0]),
    ", and a label image has several: give the file of a volume, or a folder with all slices");
  const auto isPNG = [](const std::string& path)
  { return LowerCase(fs::path(path).extension().string()) == ".png"; };
  RefuseIf(std::any_of(files.begin(), files.end(), isPNG) &&
      !std::all_of(files.begin(), files.end(), isPNG),
    "it holds files of TIFF and of PNG: take those that are no slices out of the folder");
  CheckNumbers(files);
  ScalarImage image;
  for (std::size_t k = 0; k < files.size(); ++k)
  {
    Reading of = reading; // whose memory is for one slice
    of.Allocate = AllocateVoxels;
    of.Warnings.clear();
    const ScalarImage slice = ReadSlice(files[k], of);
    const std::size_t bytes = slice.NumberOfVoxels() * SizeOf(slice.Type);
    if (k == 0)
    {
      image.Type = slice.Type;
      SetSizes(image,
        { slice.Dimensions[0], slice.Dimensions[1], static_cast<std::int64_t>(files.size()) });
      image.Scalars = reading.Allocate(bytes * files.size());
      reading.Warnings = of.Warnings;
    }
    RefuseIf(slice.Type != image.Type || slice.Dimensions[0] != image.Dimensions[0] ||
        slice.Dimensions[1] != image.Dimensions[1],
      "its slices differ: ", NameInFolder(files[k]), " has ", slice.Dimensions[0], " x ",
      slice.Dimensions[1], " voxels of ", SizeOf(slice.Type), " bytes, and ",
      NameInFolder(files[0]), ' ', image.Dimensions[0], " x ", image.Dimensions[1], " of ",
      SizeOf(image.Type), ": save all alike, and take others out of the folder");
    std::memcpy(
      static_cast<std::byte*>(image.Scalars.get()) + k * bytes, slice.Scalars.get(), bytes);
  }
  reading.Files = files;
  PlaceAlongAxes(image, { 1, 1, 1 }, {});
  reading.SpacingGuesses.emplace_back(
    "it is a folder of slices, which do not say how large their voxels are: they are taken to be "
    "1 x 1 x 1: give their size with SetSpacing()");
  reading.HasPlace = false;
  return image;
}

} // namespace voxplex::io
