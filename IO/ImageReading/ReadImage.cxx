// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadImage.h"

#include "ReaderProcess/SharedMemory.h"
#include "Readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <vector>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

struct Format
{
  bool (*Is)(const InputFile& file);
  Reader Read; ///< in this process, or apart: where a library reads it
};

/** By what is surest in the first bytes of a file. MRC has three letters there, which may be in a comment of others. */
constexpr std::array<Format, 9> Formats{ {
  { IsNRRD, ReadNRRD },
  { IsDICOM, ReadApart },
  { IsTIFF, ReadApart },
  { IsVTK, ReadApart },
  { IsGIPL, ReadGIPL },
  { IsNIfTI, ReadNIfTI },
  { IsMetaImage, ReadMetaImage },
  { IsMGH, ReadMGH },
  { IsMRC, ReadMRC },
} };

/** Files that people try, and what they are. */
struct Stranger
{
  std::string_view Begin;
  const char* What;
};

constexpr const char* Picture = "it is a picture of one slice, and a label image has several";

constexpr std::array<Stranger, 20> Strangers{ {
  { "\x89PNG", Picture },
  { "\xff\xd8\xff", Picture },
  { "BM", Picture },
  { "GIF8", Picture },
  { std::string_view("\0\0\0\x0cjP  ", 8), Picture },
  { "\xff\x4f\xff\x51", Picture },
  { "P5", Picture },
  { "P6", Picture },
  { "\x89HDF\r\n",
    "it is an HDF5 file, of which there are many kinds (MINC, Imaris, ilastik ...)" },
  { "CDF", "it is a netCDF file" },
  { "PK\x03\x04", "it is a ZIP archive: unpack it first" },
  { "# === DATA DESCRIPTION FILE", "it is a Philips PAR file: convert it with dcm2niix" },
  { "##TITLE", "it is a Bruker parameter file" },
  { "\x1f\x8b",
    "it is compressed by gzip, and is not an image of NIfTI, MGH or GIPL: unpack it first" },
  { "BZh", "it is compressed by bzip2: unpack it first" },
  { "\xfd"
    "7zXZ",
    "it is compressed by xz: unpack it first" },
  { "%PDF", "it is a PDF document" },
  { "ply", "it is a surface, and not an image" },
  { "solid", "it is a surface, and not an image" },
  { "(* Content", "it is a notebook, and not an image" },
} };

[[noreturn]] void RefuseStranger(const InputFile& file)
{
  constexpr std::size_t longest = 64;
  constexpr const char* readable =
    "those that are read are NRRD, NIfTI, MetaImage, DICOM, TIFF, VTK, MGH, GIPL and MRC";
  const std::string begin = file.Beginning(longest);
  const auto stranger = std::find_if(Strangers.begin(), Strangers.end(),
    [&begin](const Stranger& one) { return begin.starts_with(one.Begin); });
  throw FileError(stranger != Strangers.end()
      ? std::string(stranger->What) + "; " + readable
      : std::string("it is not an image in a format that voxplex reads; ") + readable);
}

/** Whether frames show what each voxel is: it has a number in one of them at most, or all of its numbers add up to 1. */
template <typename T>
bool AreClasses(const ScalarImage& image)
{
  constexpr double rounding = 1e-3;
  const auto frames = static_cast<std::size_t>(image.Frames);
  const std::size_t count = image.NumberOfVoxels();
  const T* const voxels = static_cast<const T*>(image.Scalars.get());
  std::vector<bool> isUsed(frames);
  bool areApart = true;
  bool addUpToOne = true;
  for (std::size_t i = 0; i < count && (areApart || addUpToOne); ++i)
  {
    int used = 0;
    double sum = 0.0;
    for (std::size_t f = 0; f < frames; ++f)
    {
      const T voxel = voxels[f * count + i];
      if (voxel != 0)
      {
        isUsed[f] = true;
        ++used;
        sum += static_cast<double>(voxel);
      }
    }
    areApart = areApart && used <= 1;
    addUpToOne = addUpToOne && std::abs(sum - 1.0) <= rounding;
  }
  return (areApart || addUpToOne) && std::count(isUsed.begin(), isUsed.end(), true) > 1;
}

} // namespace

ScalarImage ReadFileOrFolder(const std::string& path, Reading& reading)
{
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  RefuseIf(!fs::exists(status), "there is no such file or folder");
  if (fs::is_directory(status))
  {
    for (const char* const name : { "zarr.json", ".zgroup", ".zarray" })
    {
      RefuseIf(fs::exists(fs::path(path) / name, ignored),
        "it is a Zarr folder: open the array of one resolution in Python (zarr.open), and give it "
        "to voxplex.mesh() with its spacing");
    }
    return ReadApart(path, reading);
  }
  RefuseIf(!fs::is_regular_file(status), "it is neither a regular file nor a folder");
  RefuseIf(!reading.Request.Series.empty(),
    "SetSeriesUID() needs a folder with DICOM files, and this is a file");
  const InputFile file(path);
  RefuseIf(file.Size() == 0, "the file is empty");
  const auto format = std::find_if(
    Formats.begin(), Formats.end(), [&file](const Format& one) { return one.Is(file); });
  if (format == Formats.end())
  {
    RefuseStranger(file);
  }
  return format->Read(path, reading);
}

ImageAnswer ReadImage(const ImageRequest& request)
{
  Reading reading;
  reading.Request = request;
  reading.Allocate = [](std::size_t bytes)
  {
    RefuseMoreThanMemory(bytes);
    return AllocateVoxels(bytes);
  };
  ImageAnswer answer;
  try
  {
    answer = ReadBy(ReadFileOrFolder, std::move(reading));
  }
  catch (const FileError& error)
  {
    Refuse("cannot read '", request.Path, "': ", error.what());
  }
  if (answer.Image.Frames > 1 &&
    Dispatch(
      answer.Image.Type, [&answer](auto zero) { return AreClasses<decltype(zero)>(answer.Image); }))
  {
    answer.Warnings.push_back(
      "its frames are taken for times, but look like classes (one-hot, or probabilities): if they "
      "are, make a label image of them first (numpy.argmax along the axis of frames)");
  }
  for (std::vector<std::string>* const list :
    { &answer.Warnings, &answer.SpacingGuesses, &answer.PlaceGuesses })
  {
    for (std::string& warning : *list)
    {
      warning.insert(0, request.Path + ": ");
    }
  }
  return answer;
}

} // namespace voxplex::io
