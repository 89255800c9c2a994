// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DumpSegments.cxx
 * @brief DumpSegments FILE: what DCMTK reads in a binary DICOM segmentation, as JSON: of each segment its name, number of
 * voxels and centroid.
 */
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmfg/fgpixmsr.h>
#include <dcmtk/dcmfg/fgplanor.h>
#include <dcmtk/dcmfg/fgplanpo.h>
#include <dcmtk/dcmfg/fgseg.h>
#include <dcmtk/dcmseg/segdoc.h>
#include <dcmtk/dcmseg/segment.h>
#include <dcmtk/dcmseg/segutils.h>

#include <nlohmann/json.hpp>

#include <array>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>

namespace
{

struct Sum
{
  std::array<double, 3> Place{};
  std::size_t Voxels = 0;
};

void Check(const OFCondition& condition)
{
  if (condition.bad())
  {
    throw std::runtime_error(condition.text());
  }
}

template <typename TGroup>
TGroup& GroupOf(DcmSegmentation& file, Uint32 frame, DcmFGTypes::E_FGType type)
{
  auto* group = dynamic_cast<TGroup*>(file.getFunctionalGroups().get(frame, type));
  return group ? *group : throw std::runtime_error("a functional group is missing");
}

/** Adds the voxels of a frame to its segment. */
void AddFrame(
  DcmSegmentation& file, Uint32 frame, Uint16 rows, Uint16 columns, std::map<Uint16, Sum>& sums)
{
  Uint16 number = 0;
  Check(GroupOf<FGSegmentation>(file, frame, DcmFGTypes::EFG_SEGMENTATION)
          .getReferencedSegmentNumber(number));
  std::array<Float64, 3> first{};
  Check(GroupOf<FGPlanePosPatient>(file, frame, DcmFGTypes::EFG_PLANEPOSPATIENT)
          .getImagePositionPatient(first[0], first[1], first[2]));
  std::array<Float64, 3> row{};
  std::array<Float64, 3> column{};
  Check(GroupOf<FGPlaneOrientationPatient>(file, frame, DcmFGTypes::EFG_PLANEORIENTPATIENT)
          .getImageOrientationPatient(row[0], row[1], row[2], column[0], column[1], column[2]));
  auto& measures = GroupOf<FGPixelMeasures>(file, frame, DcmFGTypes::EFG_PIXELMEASURES);
  Float64 betweenRows = 0;
  Float64 betweenColumns = 0;
  Check(measures.getPixelSpacing(betweenRows, 0));
  Check(measures.getPixelSpacing(betweenColumns, 1));
  const std::unique_ptr<DcmIODTypes::Frame> pixels(
    DcmSegUtils::unpackBinaryFrame(file.getFrame(frame), rows, columns));
  Sum& sum = sums[number];
  for (std::size_t at = 0; at < std::size_t{ rows } * columns; ++at)
  {
    if (pixels->pixData[at] != 0)
    {
      ++sum.Voxels;
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        sum.Place[axis] += first[axis] +
          row[axis] * betweenColumns * static_cast<double>(at % columns) +
          column[axis] * betweenRows * static_cast<double>(at / columns);
      }
    }
  }
}

} // namespace

int main(int, char** argv)
{
  try
  {
    DcmFileFormat format;
    Check(format.loadFile(argv[1]));
    DcmDataset& data = *format.getDataset();
    Uint16 rows = 0;
    Uint16 columns = 0;
    Check(data.findAndGetUint16(DCM_Rows, rows));
    Check(data.findAndGetUint16(DCM_Columns, columns));
    DcmSegmentation* loaded = nullptr;
    Check(DcmSegmentation::loadDataset(data, loaded));
    const std::unique_ptr<DcmSegmentation> file(loaded);
    std::map<Uint16, Sum> sums;
    for (Uint32 frame = 0; frame < file->getNumberOfFrames(); ++frame)
    {
      AddFrame(*file, frame, rows, columns, sums);
    }
    nlohmann::json told;
    for (auto& [number, sum] : sums)
    {
      OFString name;
      Check(file->getSegment(number)->getSegmentLabel(name));
      for (double& coordinate : sum.Place)
      {
        coordinate /= static_cast<double>(sum.Voxels);
      }
      told[std::to_string(number)] = { { "name", name.c_str() }, { "voxels", sum.Voxels },
        { "centroid", sum.Place } };
    }
    std::cout << told << "\n";
    return 0;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
