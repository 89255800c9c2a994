// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadImage.h"

#include "DICOMCheck.h"
#include "DataFiles.h"
#include "FileChecks.h"
#include "FileError.h"
#include "LibraryMessages.h"
#include "MetaImageCheck.h"
#include "ReadFrames.h"
#include "Segments.h"
#include "TIFFCheck.h"

#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImage.h>
#include <itkImageFileReader.h>
#include <itkImageIOFactory.h>
#include <itkImageSeriesReader.h>
#include <itkMetaDataObject.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>

#include <unistd.h>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

using FileNames = std::vector<std::string>;

[[noreturn]] void Refuse(const std::string& path, const std::string& reason)
{
  throw FileError("cannot read '" + path + "': " + reason);
}

template <typename T>
constexpr ScalarType ScalarTypeOf()
{
  if constexpr (std::is_same_v<T, float>)
  {
    return ScalarType::Float32;
  }
  else if constexpr (std::is_same_v<T, double>)
  {
    return ScalarType::Float64;
  }
  else
  {
    return IntegerType(sizeof(T), std::is_signed_v<T>).value();
  }
}

/** Takes over geometry and pixels; the pixel container lives as long as the result's Scalars. */
template <typename TImage>
ScalarImage Adopt(TImage* image)
{
  ScalarImage result;
  result.Type = ScalarTypeOf<typename TImage::PixelType>();
  const auto size = image->GetLargestPossibleRegion().GetSize();
  for (unsigned i = 0; i < 3; ++i)
  {
    result.Dimensions[i] = static_cast<int>(size[i]);
    result.Origin[i] = image->GetOrigin()[i];
    result.Spacing[i] = image->GetSpacing()[i];
    for (unsigned j = 0; j < 3; ++j)
    {
      result.Direction[3 * i + j] = image->GetDirection()[i][j];
    }
  }
  const typename TImage::PixelContainerPointer container = image->GetPixelContainer();
  result.Scalars = std::shared_ptr<void>(
    container->GetBufferPointer(), [container](void*) { /* the smart pointer does it */ });
  return result;
}

/** Slices that are not evenly spaced would be meshed at wrong places. */
void CheckSlicePositions(
  const std::string& path, const itk::MetaDataDictionary& dictionary, double spacing)
{
  constexpr double tolerated = 0.1; // of the spacing; ITK warns below that
  double deviation = 0.0;
  if (itk::ExposeMetaData(dictionary, "ITK_non_uniform_sampling_deviation", deviation) &&
    deviation > tolerated * spacing)
  {
    std::ostringstream reason;
    reason << "slices are missing, damaged or not evenly spaced: their distances differ by up to "
           << deviation << "; complete or resample the series";
    Refuse(path, reason.str());
  }
}

/** Reads one file, or the slices of a series, with pixels of type T. */
template <typename T>
ScalarImage ReadPixels(const std::string& path, const FileNames& files, itk::ImageIOBase* io)
{
  using ImageType = itk::Image<T, 3>;
  typename ImageType::Pointer image;
  if (files.size() == 1)
  {
    const auto reader = itk::ImageFileReader<ImageType>::New();
    reader->SetImageIO(io);
    reader->SetFileName(files.front());
    reader->Update();
    image = reader->GetOutput();
  }
  else
  {
    const auto reader = itk::ImageSeriesReader<ImageType>::New();
    reader->SetImageIO(io);
    reader->SetFileNames(files);
    reader->Update();
    image = reader->GetOutput();
    CheckSlicePositions(path, image->GetMetaDataDictionary(), image->GetSpacing()[2]);
  }
  image->DisconnectPipeline();
  return Adopt(image.GetPointer());
}

ScalarImage ReadPixelsOfAnyType(
  const std::string& path, const FileNames& files, itk::ImageIOBase* io)
{
  switch (io->GetComponentType())
  {
    case itk::IOComponentEnum::CHAR:
      return ReadPixels<signed char>(path, files, io);
    case itk::IOComponentEnum::UCHAR:
      return ReadPixels<unsigned char>(path, files, io);
    case itk::IOComponentEnum::SHORT:
      return ReadPixels<short>(path, files, io);
    case itk::IOComponentEnum::USHORT:
      return ReadPixels<unsigned short>(path, files, io);
    case itk::IOComponentEnum::INT:
      return ReadPixels<int>(path, files, io);
    case itk::IOComponentEnum::UINT:
      return ReadPixels<unsigned int>(path, files, io);
    case itk::IOComponentEnum::LONG:
      return ReadPixels<long>(path, files, io);
    case itk::IOComponentEnum::ULONG:
      return ReadPixels<unsigned long>(path, files, io);
    case itk::IOComponentEnum::LONGLONG:
      return ReadPixels<long long>(path, files, io);
    case itk::IOComponentEnum::ULONGLONG:
      return ReadPixels<unsigned long long>(path, files, io);
    case itk::IOComponentEnum::FLOAT:
      return ReadPixels<float>(path, files, io);
    case itk::IOComponentEnum::DOUBLE:
      return ReadPixels<double>(path, files, io);
    default:
      Refuse(path, "its scalar type is not supported");
  }
}

/** "6 x 5 x 4" */
std::string DescribeSize(const itk::ImageIOBase& io)
{
  std::ostringstream size;
  for (unsigned i = 0; i < io.GetNumberOfDimensions(); ++i)
  {
    size << (i ? " x " : "") << io.GetDimensions(i);
  }
  return size.str();
}

void CheckAxis(const std::string& path, const itk::ImageIOBase& io, unsigned axis)
{
  const double spacing = io.GetSpacing(axis);
  if (!(spacing > 0) || !std::isfinite(spacing))
  {
    std::ostringstream reason;
    reason << (axis < 3 ? "the voxel spacing along axis " : "the time step along axis ") << axis
           << " is " << spacing << " in its header; it must be a positive "
           << (axis < 3 ? "length" : "number") << ": correct the header";
    Refuse(path, reason.str());
  }
  if (!std::isfinite(io.GetOrigin(axis)))
  {
    Refuse(path,
      "the origin along axis " + std::to_string(axis) +
        " is not a finite number in its header: correct the header");
  }
  if (io.GetDimensions(axis) > static_cast<std::size_t>(std::numeric_limits<int>::max()))
  {
    Refuse(path, "it has more than 2147483647 voxels along axis " + std::to_string(axis));
  }
}

/**
 * What the header says must be a 3D or 4D image of one component, or a 3D image with one component
 * for each time frame, before pixels are read.
 */
void CheckHeader(const std::string& path, const itk::ImageIOBase& io)
{
  const unsigned axes = CountAxes(io);
  if (axes > 4)
  {
    Refuse(path,
      "it has " + std::to_string(axes) + " dimensions (" + DescribeSize(io) +
        "); voxplex meshes images of three, and of four with time as the last: extract one of "
        "those first");
  }
  const std::string layers = DescribeLayers(path);
  if (io.GetNumberOfComponents() != 1 && !layers.empty())
  {
    Refuse(path,
      "its segments overlap, so that they are stored in " +
        std::to_string(io.GetNumberOfComponents()) + " layers: " + layers +
        "; a label image has one label a voxel: in 3D Slicer, export the segmentation to a label "
        "map, which decides for one segment where several overlap, and save that");
  }
  if (io.GetNumberOfComponents() != 1 && !ComponentsAreFrames(path, io))
  {
    Refuse(path,
      "it has " + std::to_string(io.GetNumberOfComponents()) +
        " components a voxel (colours or vectors); a label image has one: "
        "export it as a label map first, or, if they are time frames, as an image of four "
        "dimensions");
  }
  for (unsigned axis = 0; axis < std::min(axes, io.GetNumberOfDimensions()); ++axis)
  {
    CheckAxis(path, io, axis);
  }
}

/** One frame or several. */
ScalarImage ReadChecked(const std::string& path, const FileNames& files, itk::ImageIOBase* io,
  std::vector<std::string>& warnings)
{
  if (files.size() == 1 && (CountAxes(*io) == 4 || io->GetNumberOfComponents() > 1))
  {
    return ReadFrames(path, *io, warnings);
  }
  return ReadPixelsOfAnyType(path, files, io);
}

/** ITK's words for what is more particular than a damaged file, in ours; or an empty string. */
std::string ExplainHeader(const std::string& message)
{
  if (message.find("determinant is 0") != std::string::npos)
  {
    return "its axes are not independent, the direction matrix is singular: correct the header";
  }
  if (message.find("#independent axes") != std::string::npos)
  {
    return "its header gives space directions to fewer axes than have the kind 'domain', 'space' "
           "or 'time': give the axis of time the kind 'list', or a space of four dimensions such "
           "as left-posterior-superior-time";
  }
  return "";
}

/** What ITK would not notice. */
void CheckFile(const std::string& path, const itk::ImageIOBase& io)
{
  const std::string format = io.GetNameOfClass();
  std::string fault;
  if (format == "NiftiImageIO")
  {
    fault = FindFaultOfNIfTI(path);
  }
  else if (format == "NrrdImageIO" || format == "MetaImageIO")
  {
    // What says more comes first: of spacings, the text header's check.
    fault = FindFaultOfNamedFiles(path);
    fault = fault.empty() ? FindFaultOfTextHeader(path) : fault;
    if (fault.empty() && format == "MetaImageIO")
    {
      fault = FindFaultOfMetaImage(path);
    }
  }
  if (!fault.empty())
  {
    Refuse(path, fault);
  }
}

ScalarImage ReadWith(const std::string& path, const FileNames& files, itk::ImageIOBase* io,
  LibraryMessages& messages, std::vector<std::string>& warnings)
{
  io->SetFileName(files.front());
  CheckFile(files.front(), *io);
  io->ReadImageInformation();
  CheckHeader(path, *io);
  if (const std::string fault = FindFaultOfSize(files, *io); !fault.empty())
  {
    Refuse(path, fault);
  }
  ScalarImage image = ReadChecked(path, files, io, warnings);
  if (const std::string damage = messages.DamageReport(); !damage.empty())
  {
    Refuse(path, "the file is truncated or damaged (" + damage + ")");
  }
  return image;
}

void CheckReadable(const std::string& path)
{
  std::error_code ignored;
  if (!fs::exists(path, ignored))
  {
    Refuse(path, "there is no such file or folder");
  }
  if (access(path.c_str(), R_OK) != 0)
  {
    Refuse(path, std::strerror(errno));
  }
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::is_regular_file(status) && !fs::is_directory(status))
  {
    Refuse(path, "it is neither a regular file nor a folder");
  }
  if (fs::is_regular_file(status) && fs::file_size(path, ignored) == 0)
  {
    Refuse(path, "the file is empty");
  }
}

/** Formats that hold no volumes. libpng, for one, calls abort() when a file is damaged. */
bool IsPicture(const itk::ImageIOBase& io)
{
  const std::string format = io.GetNameOfClass();
  return format == "PNGImageIO" || format == "JPEGImageIO" || format == "BMPImageIO";
}

/** The reader of the file's format; null if there is none. What says that it is DICOM is offered to GDCM alone. */
itk::ImageIOBase::Pointer FindReader(const std::string& path)
{
  if (!HasPreambleOfDICOM(path))
  {
    return itk::ImageIOFactory::CreateImageIO(path.c_str(), itk::IOFileModeEnum::ReadMode);
  }
  const itk::ImageIOBase::Pointer io = itk::GDCMImageIO::New().GetPointer();
  return io->CanReadFile(path.c_str()) ? io : nullptr;
}

ScalarImage ReadFile(
  const std::string& path, LibraryMessages& messages, std::vector<std::string>& warnings)
{
  if (const std::string fault = FindFaultOfDICOM(path); !fault.empty())
  {
    Refuse(path, fault);
  }
  if (const std::string fault = FindFaultOfTIFF(path); !fault.empty() && !HasPreambleOfDICOM(path))
  {
    Refuse(path, fault);
  }
  const itk::ImageIOBase::Pointer io = FindReader(path);
  if (!io)
  {
    Refuse(path,
      "it is not an image in a format that ITK reads (NRRD, NIfTI, MetaImage, DICOM, ...), or its "
      "header is damaged");
  }
  if (IsPicture(*io))
  {
    Refuse(path,
      "it is a picture of one slice, and a label image has several: give a volume (NRRD, "
      "NIfTI, MetaImage, DICOM, ...)");
  }
  return ReadWith(path, { path }, io, messages, warnings);
}

std::string ListSeries(itk::GDCMSeriesFileNames* names, const FileNames& series)
{
  std::ostringstream list;
  for (const std::string& uid : series)
  {
    list << "\n  SetSeriesUID(\"" << uid << "\")  (" << names->GetFileNames(uid).size()
         << " files)";
  }
  return list.str();
}

/** The one series of a folder, or the one that the user asks for. */
std::string ChooseSeries(const std::string& path, itk::GDCMSeriesFileNames* names,
  const FileNames& available, const std::string& wanted)
{
  if (available.empty())
  {
    Refuse(path, "the folder holds no DICOM images");
  }
  FileNames matching;
  for (const std::string& uid : available)
  {
    // ITK appends details to the UID when a series has images of different kinds.
    if (uid == wanted)
    {
      return uid;
    }
    if (uid.rfind(wanted, 0) == 0)
    {
      matching.push_back(uid);
    }
  }
  if (matching.empty())
  {
    Refuse(
      path, "there is no DICOM series '" + wanted + "'; there are" + ListSeries(names, available));
  }
  if (matching.size() > 1)
  {
    Refuse(path,
      "the folder holds " + std::to_string(matching.size()) + " DICOM series; choose one with" +
        ListSeries(names, matching));
  }
  return matching.front();
}

/** Before GDCM reads all of them to see what series there are. */
void CheckFilesOfFolder(const std::string& path)
{
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(path, ignored))
  {
    const std::string name = "'" + entry.path().filename().string() + "'";
    const fs::file_status status = entry.status(ignored);
    if (fs::is_fifo(status) || fs::is_character_file(status))
    {
      Refuse(path, name + " is not a regular file");
    }
    if (const std::string fault = FindFaultOfDICOM(entry.path().string()); !fault.empty())
    {
      Refuse(path, name + ": " + fault);
    }
  }
}

ScalarImage ReadFolder(const std::string& path, const std::string& wanted,
  LibraryMessages& messages, std::vector<std::string>& warnings)
{
  CheckFilesOfFolder(path);
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(true);
  names->SetDirectory(path);
  const std::string uid = ChooseSeries(path, names, names->GetSeriesUIDs(), wanted);
  const FileNames files = names->GetFileNames(uid);
  return ReadWith(path, files, itk::GDCMImageIO::New(), messages, warnings);
}

/** What read() returns. @throws FileError naming the path, for any exception of ITK */
template <typename TRead>
ScalarImage Translate(const std::string& path, const LibraryMessages& messages, TRead&& read)
{
  try
  {
    return read();
  }
  catch (const FileError&)
  {
    throw;
  }
  catch (const std::bad_alloc&)
  {
    Refuse(path, "it does not fit into memory");
  }
  catch (const itk::MemoryAllocationError&)
  {
    Refuse(path, "it does not fit into memory");
  }
  catch (const itk::ExceptionObject& error)
  {
    const std::string summary = messages.Summarize(error.GetDescription());
    if (const std::string explanation = ExplainHeader(summary); !explanation.empty())
    {
      Refuse(path, explanation);
    }
    Refuse(path, "the file is truncated or damaged (" + summary + ")");
  }
  catch (const std::exception& error)
  {
    Refuse(path, messages.Summarize(error.what()));
  }
}

} // namespace

ScalarImage ReadImage(
  const std::string& path, const std::string& series, std::vector<std::string>& warnings)
{
  CheckReadable(path);
  LibraryMessages messages;
  std::error_code ignored;
  const bool isFolder = fs::is_directory(path, ignored);
  if (!isFolder && !series.empty())
  {
    Refuse(path, "SetSeriesUID() needs a folder with DICOM files, and this is a file");
  }
  ScalarImage image = Translate(path, messages,
    [&]
    {
      return isFolder ? ReadFolder(path, series, messages, warnings)
                      : ReadFile(path, messages, warnings);
    });
  for (const std::string& warning : messages.Warnings())
  {
    warnings.push_back(path + ": " + warning);
  }
  return image;
}

} // namespace voxplex::io
