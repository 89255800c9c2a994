// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageFile.h"

#include "FileError.h"
#include "LabelTable.h"

#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkSegmentationReader.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

namespace voxplex::cli
{
namespace
{

const char* TypeName(int type)
{
  switch (type)
  {
    case VTK_SIGNED_CHAR:
    case VTK_CHAR:
      return "int8";
    case VTK_UNSIGNED_CHAR:
      return "uint8";
    case VTK_SHORT:
      return "int16";
    case VTK_UNSIGNED_SHORT:
      return "uint16";
    case VTK_INT:
      return "int32";
    case VTK_UNSIGNED_INT:
      return "uint32";
    case VTK_FLOAT:
      return "float";
    case VTK_DOUBLE:
      return "double";
    case VTK_UNSIGNED_LONG:
    case VTK_UNSIGNED_LONG_LONG:
      return "uint64";
    default:
      return "int64";
  }
}

void PutPoint(std::ostream& header, const double (&point)[3])
{
  header << '(' << point[0] << ',' << point[1] << ',' << point[2] << ')';
}

void PutPlace(std::ostream& header, vtkImageData* image, bool isSeries)
{
  header << "space directions:";
  for (int axis = 0; axis < 3; ++axis)
  {
    double column[3];
    for (int row = 0; row < 3; ++row)
    {
      column[row] = image->GetDirectionMatrix()->GetElement(row, axis) * image->GetSpacing()[axis];
    }
    header << ' ';
    PutPoint(header, column);
  }
  double origin[3];
  image->GetOrigin(origin);
  header << (isSeries ? " none" : "") << "\nspace origin: ";
  PutPoint(header, origin);
  header << "\nkinds: domain domain domain" << (isSeries ? " list" : "") << '\n';
}

/** As NRRD has texts of keys: with escapes, in one line. */
std::string Escaped(const std::string& name)
{
  std::string text;
  for (const char c : name)
  {
    text += c == '\\' ? "\\\\" : c == '\n' ? "\\n" : std::string(1, c == '\r' ? ' ' : c);
  }
  return text;
}

void PutLabels(std::ostream& header, const LabelTable& table)
{
  int number = 0;
  for (const auto& [value, entry] : table.Entries)
  {
    const std::string segment = "Segment" + std::to_string(number++) + "_";
    header << segment << "ID:=Segment_" << value << '\n'
           << segment << "LabelValue:=" << value << '\n'
           << segment << "Layer:=0\n"
           << segment << "Name:=" << Escaped(entry.Name) << '\n';
    if (entry.Color)
    {
      const auto& [red, green, blue] = *entry.Color;
      header << segment << "Color:=" << red << ' ' << green << ' ' << blue << '\n';
    }
  }
}

std::string Header(vtkSegmentationReader* reader, vtkImageData* image)
{
  const int frames = reader->GetNumberOfFrames();
  const bool isSeries = frames > 1;
  const int* const size = image->GetDimensions();
  std::ostringstream header;
  header.precision(std::numeric_limits<double>::max_digits10);
  header << "NRRD0005\ntype: " << TypeName(image->GetScalarType())
         << "\ndimension: " << (isSeries ? 4 : 3) << "\nspace: "
         << (reader->GetSpace() == vtkSegmentationReader::SPACE_LPS ? "left-posterior-superior"
                                                                    : "right-anterior-superior")
         << "\nsizes: " << size[0] << ' ' << size[1] << ' ' << size[2];
  if (isSeries)
  {
    header << ' ' << frames;
  }
  header << '\n';
  PutPlace(header, image, isSeries);
  header << "endian: " << (std::endian::native == std::endian::little ? "little" : "big")
         << "\nencoding: raw\n";
  if (isSeries)
  {
    header << "axis 3 index values:=";
    for (int frame = 0; frame < frames; ++frame)
    {
      header << (frame > 0 ? " " : "") << reader->GetTimeOfFrame(frame);
    }
    header << '\n';
  }
  PutLabels(header, GetLabelTable(image->GetFieldData()));
  header << '\n';
  return header.str();
}

} // namespace

void WriteImage(vtkSegmentationReader* reader, vtkAlgorithm* source, const std::string& path)
{
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  auto* const image = vtkImageData::SafeDownCast(source->GetOutputDataObject(0));
  file << Header(reader, image);
  const int type = image->GetScalarType();
  for (int frame = 0; file && frame < reader->GetNumberOfFrames(); ++frame)
  {
    source->UpdateTimeStep(reader->GetTimeOfFrame(frame));
    vtkDataArray* const voxels = image->GetPointData()->GetScalars();
    if (!voxels || voxels->GetDataType() != type)
    {
      throw io::FileError(
        "cannot read frame " + std::to_string(frame) + ": " + reader->GetErrorMessage());
    }
    file.write(static_cast<const char*>(voxels->GetVoidPointer(0)),
      static_cast<std::streamsize>(voxels->GetNumberOfValues()) * voxels->GetDataTypeSize());
  }
  file.close();
  if (!file)
  {
    throw io::FileError(std::string("cannot write the image: ") + std::strerror(errno));
  }
}

} // namespace voxplex::cli
