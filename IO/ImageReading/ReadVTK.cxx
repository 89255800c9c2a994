// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "VTKFileStructure.h"
#include "VTKImage.h"
#include "VTKMessages.h"

#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStructuredPoints.h>
#include <vtkStructuredPointsReader.h>
#include <vtkXMLImageDataReader.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string_view>

namespace voxplex::io
{
namespace
{

// --- Which reader

/** What the fourth line says. */
std::string LegacyType(const std::string& beginning)
{
  std::istringstream stream(beginning);
  std::string line;
  for (int i = 0; i < 3; ++i) // version, title, encoding
  {
    std::getline(stream, line);
  }
  std::string keyword;
  std::string type;
  stream >> keyword >> type;
  for (std::string* word : { &keyword, &type })
  {
    std::transform(word->begin(), word->end(), word->begin(),
      [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
  }
  return keyword == "DATASET" ? type : keyword;
}

/** Before memory is taken. A bit of the file is a voxel at least, and a byte is one that is compressed. */
void CheckClaim(vtkAlgorithm* reader, std::uint64_t size, double mostOfAByte)
{
  std::array<int, 6> extent{ 0, -1, 0, -1, 0, -1 };
  reader->GetOutputInformation(0)->Get(
    vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent.data());
  double voxels = 1.0;
  std::string sizes;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const std::int64_t length = std::int64_t{ extent[2 * axis + 1] } - extent[2 * axis] + 1;
    voxels *= static_cast<double>(std::max<std::int64_t>(0, length));
    sizes += (sizes.empty() ? "" : " x ") + std::to_string(length);
  }
  RefuseIf(voxels == 0, "its header claims ", sizes,
    " points (DIMENSIONS or extent), which no image has: correct the header");
  RefuseIf(voxels > mostOfAByte * static_cast<double>(size),
    "it is truncated or damaged: its header claims ", sizes, " points, and the file has ", size,
    " bytes");
}

vtkSmartPointer<vtkImageData> ReadLegacy(const InputFile& file, const VTKMessages& messages)
{
  vtkNew<vtkStructuredPointsReader> reader;
  reader->SetFileName(file.Path().c_str());
  reader->UpdateInformation();
  messages.CheckErrors();
  constexpr double bits = 8.0;
  CheckClaim(reader, file.Size(), bits);
  reader->Update();
  messages.CheckErrors();
  return reader->GetOutput();
}

vtkSmartPointer<vtkImageData> ReadXML(const InputFile& file, const VTKMessages& messages)
{
  CheckStructureOfVTI(file);
  vtkNew<WithRoomForTexts<vtkXMLImageDataReader>> reader;
  reader->SetFileName(file.Path().c_str());
  reader->UpdateInformation();
  messages.CheckErrors();
  RefuseIf(reader->GetNumberOfTimeSteps() > 1, "it holds ", reader->GetNumberOfTimeSteps(),
    " time steps: save each in a file of its own, or all of them as NRRD or NIfTI");
  constexpr double compressed = 65536.0;
  CheckClaim(reader, file.Size(), compressed);
  reader->Update();
  messages.CheckErrors();
  return reader->GetOutput();
}

} // namespace

ScalarImage ReadVTK(const std::string& path, Reading& reading)
{
  const InputFile file(path);
  const std::string beginning = BeginningOfVTK(file);
  const bool isLegacy = IsLegacyVTK(beginning);
  if (isLegacy)
  {
    CheckKindOfVTK(LegacyType(beginning), "STRUCTURED_POINTS");
  }
  const VTKMessages messages;
  const vtkSmartPointer<vtkImageData> image =
    isLegacy ? ReadLegacy(file, messages) : ReadXML(file, messages);
  for (const std::string& warning : messages.Warnings())
  {
    reading.Warnings.push_back(warning);
  }
  return TakeVTKImage(image, reading.Allocate, reading.Labels, reading.Warnings);
}

} // namespace voxplex::io
