// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "DICOMSlices.h"

#include "FileError.h"
#include "Text.h"

#include <gdcmUIDs.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace voxplex::io
{
namespace
{

constexpr DICOMTag MediaStorage{ 0x00020002, "Media Storage SOP Class UID" };
constexpr DICOMTag ImageType{ 0x00080008, "Image Type" };
constexpr DICOMTag SOPClass{ 0x00080016, "SOP Class UID" };
constexpr DICOMTag NominalSpacing{ 0x00182010, "Nominal Scanned Pixel Spacing" };
constexpr DICOMTag SliceThickness{ 0x00180050, "Slice Thickness" };
constexpr DICOMTag SpacingBetweenSlices{ 0x00180088, "Spacing Between Slices" };
constexpr DICOMTag ImagePosition{ 0x00200032, "Image Position (Patient)" };
constexpr DICOMTag ImageOrientation{ 0x00200037, "Image Orientation (Patient)" };
constexpr DICOMTag PlanePosition{ 0x00209113, "Plane Position Sequence" };
constexpr DICOMTag PlaneOrientation{ 0x00209116, "Plane Orientation Sequence" };
constexpr DICOMTag PixelSpacing{ 0x00280030, "Pixel Spacing" };
constexpr DICOMTag RescaleIntercept{ 0x00281052, "Rescale Intercept" };
constexpr DICOMTag RescaleSlope{ 0x00281053, "Rescale Slope" };
constexpr DICOMTag ModalityTable{ 0x00283000, "Modality LUT Sequence" };
constexpr DICOMTag PixelMeasures{ 0x00289110, "Pixel Measures Sequence" };
constexpr DICOMTag PixelTransformation{ 0x00289145, "Pixel Value Transformation Sequence" };
constexpr DICOMTag GridFrameOffsets{ 0x3004000C, "Grid Frame Offset Vector" };
constexpr DICOMTag DoseGridScaling{ 0x3004000E, "Dose Grid Scaling" };
constexpr DICOMTag SharedGroups{ 0x52009229, "Shared Functional Groups Sequence" };
constexpr DICOMTag GroupsOfFrames{ 0x52009230, "Per-frame Functional Groups Sequence" };
constexpr DICOMTag FloatPixels{ 0x7FE00008, "Float Pixel Data" };
constexpr DICOMTag DoublePixels{ 0x7FE00009, "Double Float Pixel Data" };
constexpr DICOMTag PixelData{ 0x7FE00010, "Pixel Data" };

/** Of directions, which must have length 1 and be at a right angle, as texts have few digits. */
constexpr double Tolerance = 1e-3;

double Dot(const Vector3& a, const Vector3& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3 Combine(const Vector3& a, double factor, const Vector3& b)
{
  return { a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2] };
}

double Length(const Vector3& a)
{
  return std::sqrt(Dot(a, a));
}

/** Of length 1. */
Vector3 NormalOf(const DICOMSlice& slice)
{
  const Vector3& a = slice.Row;
  const Vector3& b = slice.Column;
  const Vector3 cross{ a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0] };
  return Combine({}, 1.0 / Length(cross), cross);
}

/**
 * The item with a functional group: of the frame, of all frames, or where there are no groups, the file. Empty items
 * are found if it is nowhere.
 */
class Groups
{
public:
  Groups(const DICOMDataSet& data, const DICOMDataSet* shared, const DICOMDataSet* ofFrame)
    : File(data)
    , Shared(shared)
    , OfFrame(ofFrame)
  {
  }

  /** @return empty if it is missing */
  std::vector<double> Numbers(const DICOMTag& group, const DICOMTag& tag, std::size_t count) const
  {
    for (const DICOMDataSet* groups : { this->OfFrame, this->Shared })
    {
      const std::vector<DICOMDataSet> items =
        groups ? groups->Items(group) : std::vector<DICOMDataSet>();
      RefuseIf(items.size() > 1, "its ", group, " has several items for a frame");
      if (items.size() == 1)
      {
        if (std::vector<double> numbers = items[0].Numbers(tag, count); !numbers.empty())
        {
          return numbers;
        }
      }
    }
    return this->OfFrame ? std::vector<double>() : this->File.Numbers(tag, count);
  }

  std::vector<double> Required(const DICOMTag& group, const DICOMTag& tag, std::size_t count) const
  {
    std::vector<double> numbers = this->Numbers(group, tag, count);
    RefuseIf(numbers.empty(), "it has no ", tag,
      ", so that where its voxels are is not known: convert it to NRRD with its geometry first (3D "
      "Slicer)");
    return numbers;
  }

private:
  const DICOMDataSet& File;
  const DICOMDataSet* Shared;
  const DICOMDataSet* OfFrame;
};

void ReadDirections(DICOMSlice& slice, const Groups& groups)
{
  const std::vector<double> cosines = groups.Required(PlaneOrientation, ImageOrientation, 6);
  std::vector<double> spacing = groups.Numbers(PixelMeasures, PixelSpacing, 2);
  if (spacing.empty()) // ITK writes images without a modality as captured ones
  {
    spacing = groups.Numbers(PixelMeasures, NominalSpacing, 2);
  }
  if (spacing.empty())
  {
    spacing = groups.Required(PixelMeasures, PixelSpacing, 2);
  }
  const Vector3 row{ cosines[0], cosines[1], cosines[2] };
  const Vector3 column{ cosines[3], cosines[4], cosines[5] };
  RefuseIf(std::abs(Length(row) - 1.0) > Tolerance || std::abs(Length(column) - 1.0) > Tolerance ||
      std::abs(Dot(row, column)) > Tolerance,
    "its ", ImageOrientation,
    " is not two directions of length 1 at a right angle: correct its header");
  RefuseIf(!(spacing[0] > 0.0) || !(spacing[1] > 0.0), "its ", PixelSpacing, " is ", spacing[0],
    " and ", spacing[1], "; these must be positive lengths: correct its header");
  // The first spacing is that from row to row.
  slice.Row = Combine({}, spacing[1] / Length(row), row);
  slice.Column = Combine({}, spacing[0] / Length(column), column);
}

void ReadRescaling(DICOMSlice& slice, const Groups& groups)
{
  const std::vector<double> slope = groups.Numbers(PixelTransformation, RescaleSlope, 1);
  const std::vector<double> intercept = groups.Numbers(PixelTransformation, RescaleIntercept, 1);
  slice.Slope = slope.empty() ? 1.0 : slope[0];
  slice.Intercept = intercept.empty() ? 0.0 : intercept[0];
  RefuseIf(slice.Slope == 0.0, "its ", RescaleSlope,
    " is 0, with which all voxels have one value: correct its header");
}

/** All but the name and the number. */
DICOMSlice ReadSlice(const Groups& groups)
{
  DICOMSlice slice;
  const std::vector<double> position = groups.Required(PlanePosition, ImagePosition, 3);
  slice.Position = { position[0], position[1], position[2] };
  ReadDirections(slice, groups);
  ReadRescaling(slice, groups);
  const std::vector<double> distance = groups.Numbers(PixelMeasures, SpacingBetweenSlices, 1);
  const std::vector<double> thickness = groups.Numbers(PixelMeasures, SliceThickness, 1);
  slice.Distance = distance.empty() ? 0.0 : std::abs(distance[0]);
  slice.Thickness = thickness.empty() ? 0.0 : thickness[0];
  return slice;
}

/** A dose has one place, and the distances of its frames from it. */
std::vector<DICOMSlice> ReadDose(const DICOMDataSet& data, std::size_t frames)
{
  const std::vector<double> offsets = data.AnyNumbers(GridFrameOffsets);
  DICOMSlice first = ReadSlice(Groups(data, nullptr, nullptr));
  const bool isAxial = NormalOf(first) == Vector3{ 0.0, 0.0, 1.0 };
  const double start = isAxial && !offsets.empty() && offsets[0] == first.Position[2]
    ? offsets[0] // they are places along z
    : 0.0;
  RefuseIf(offsets.size() != frames || offsets[0] != start, "its ", GridFrameOffsets, " has ",
    offsets.size(), " offsets for ", frames,
    " frames, or does not begin with 0: convert it to NRRD first (3D Slicer)");
  const std::vector<double> scale = data.Numbers(DoseGridScaling, 1);
  first.Slope = scale.empty() ? 1.0 : scale[0];
  const Vector3 normal = NormalOf(first);
  std::vector<DICOMSlice> slices(frames, first);
  for (std::size_t i = 0; i < frames; ++i)
  {
    slices[i].Position = Combine(first.Position, offsets[i] - start, normal);
  }
  return slices;
}

/** In the order of frames. */
std::vector<DICOMSlice> ReadFrames(const DICOMDataSet& data, std::size_t frames)
{
  const std::vector<DICOMDataSet> shared = data.Items(SharedGroups);
  const std::vector<DICOMDataSet> ofFrames = data.Items(GroupsOfFrames);
  if (ofFrames.empty() && data.Find(GridFrameOffsets))
  {
    return ReadDose(data, frames);
  }
  RefuseIf(ofFrames.empty() && frames > 1, "its ", frames,
    " frames have no places in space: they are a film or pictures, and no slices of a volume, or "
    "the places were lost (there is no ",
    GroupsOfFrames, "): export slices with their positions");
  RefuseIf(!ofFrames.empty() && ofFrames.size() != frames, "it has ", frames, " frames, and ",
    ofFrames.size(), " items in its ", GroupsOfFrames, ": correct its header");
  std::vector<DICOMSlice> slices;
  for (std::size_t i = 0; i < frames; ++i)
  {
    slices.push_back(ReadSlice(Groups(
      data, shared.empty() ? nullptr : &shared[0], ofFrames.empty() ? nullptr : &ofFrames[i])));
  }
  return slices;
}

void CheckDirections(const std::vector<DICOMSlice>& slices)
{
  constexpr double tolerated = 1e-4; // of a voxel, from one to the next
  const DICOMSlice& first = slices.front();
  const double allowed = tolerated * std::min(Length(first.Row), Length(first.Column));
  for (const DICOMSlice& slice : slices)
  {
    RefuseIf(Length(Combine(slice.Row, -1.0, first.Row)) > allowed ||
        Length(Combine(slice.Column, -1.0, first.Column)) > allowed,
      first.Name, " and ", slice.Name, " differ in ", ImageOrientation, " or ", PixelSpacing,
      ": slices of one volume are parallel and alike; take the others away first");
  }
}

/** The slices are sorted. */
void FillGaps(std::vector<DICOMSlice>& slices, const Vector3& normal)
{
  constexpr double most = 10'000; // few frames must not ask for much memory
  std::vector<DICOMSlice> all;
  for (const DICOMSlice& slice : slices)
  {
    const double distance = slices.front().Distance;
    const DICOMSlice before = all.empty() ? slice : all.back();
    const Vector3 between = Combine(slice.Position, -1.0, before.Position);
    const double gap = Dot(between, normal);
    const double missing = distance > 0 ? std::round(gap / distance) - 1.0 : 0.0;
    RefuseIf(missing + static_cast<double>(all.size()) > most, before.Name, " and ", slice.Name,
      " are ", gap, " mm apart, and its ", SpacingBetweenSlices, " is ", distance,
      ": correct its header");
    for (double i = 1.0; i <= missing; ++i)
    {
      all.push_back(before);
      all.back().Frame = DICOMSlice::NoFrame;
      all.back().Position = Combine(before.Position, i / (missing + 1.0), between);
    }
    all.push_back(slice);
  }
  slices = std::move(all);
}

} // namespace

void CheckObject(const DICOMDataSet& data)
{
  struct Unsuitable
  {
    std::string_view UID;
    const char* Reason;
  };
  constexpr std::array<Unsuitable, 6> unsuitable{ {
    { "1.2.840.10008.1.3.10",
      "a DICOMDIR, which lists other files: give one of these, or the folder of a series" },
    { "1.2.840.10008.5.1.4.1.1.66.4",
      "a DICOM segmentation object, whose segments are frames apart and may overlap: convert it to "
      "a label map (dcmqi's segimage2itkimage, 3D Slicer)" },
    { "1.2.840.10008.5.1.4.1.1.66.5",
      "a DICOM surface segmentation, which has surfaces and no voxels: convert it to a label map "
      "(3D Slicer)" },
    { "1.2.840.10008.5.1.4.1.1.481.3",
      "a DICOM RT structure set, which has contours and no voxels: convert it to a label map (3D "
      "Slicer, plastimatch)" },
    { "1.2.840.10008.5.1.4.1.1.77.1.6",
      "a whole-slide microscopy image, the frames of which are tiles of a picture and no slices" },
    { "1.2.840.10008.5.1.4.1.1.30",
      "a parametric map, the voxels of which may be real numbers: convert it to NRRD (dcmqi's "
      "paramap2itkimage)" },
  } };
  const std::string uid =
    data.Text(SOPClass).empty() ? data.Text(MediaStorage) : data.Text(SOPClass);
  const auto found = std::find_if(
    unsuitable.begin(), unsuitable.end(), [&uid](const Unsuitable& one) { return one.UID == uid; });
  if (found != unsuitable.end())
  {
    Refuse("it is ", found->Reason);
  }
  if (!data.Find(PixelData))
  {
    gdcm::UIDs names;
    const bool isFloat = data.Find(FloatPixels) || data.Find(DoublePixels);
    Refuse("it is a DICOM object ", isFloat ? "of real numbers" : "without pixels", " ('",
      (names.SetFromUID(uid.c_str()) ? std::string(names.GetName()) : Excerpt(uid)),
      "'), or it is cut off before them: give images of slices");
  }
  RefuseIf(data.Text(ImageType).find("MOSAIC") != std::string::npos,
    "it is a mosaic of Siemens, one picture with all slices side by side: convert it to NIfTI "
    "first (dcm2niix)");
  RefuseIf(data.Find(ModalityTable), "its voxels stand for others in a table (", ModalityTable,
    "), which is not supported: apply it first");
}

std::vector<DICOMSlice> ReadSlices(const DICOMDataSet& data, int frames)
{
  std::vector<DICOMSlice> slices = ReadFrames(data, static_cast<std::size_t>(frames));
  for (int i = 0; i < frames; ++i)
  {
    slices[static_cast<std::size_t>(i)].Name = "frame " + std::to_string(i + 1);
    slices[static_cast<std::size_t>(i)].Frame = i;
  }
  return slices;
}

Vector3 ArrangeSlices(
  std::vector<DICOMSlice>& slices, bool isComplete, std::vector<std::string>& warnings)
{
  constexpr double samePlace = 0.01; // of the distance of slices
  constexpr double tolerated = 0.1;
  constexpr double toleratedInPlane = 0.25; // of a voxel
  CheckDirections(slices);
  const Vector3 normal = NormalOf(slices.front());
  std::stable_sort(slices.begin(), slices.end(),
    [&normal](const DICOMSlice& a, const DICOMSlice& b)
    { return Dot(a.Position, normal) < Dot(b.Position, normal); });
  if (slices.size() == 1)
  {
    const DICOMSlice& only = slices[0];
    const double known = only.Distance > 0 ? only.Distance : only.Thickness;
    if (known == 0)
    {
      std::ostringstream warning;
      warning << "it is one slice, of which the thickness is not known: " << Length(only.Row)
              << " mm was taken, as between columns";
      warnings.push_back(warning.str());
    }
    return Combine({}, known == 0 ? Length(only.Row) : known, normal);
  }
  if (!isComplete)
  {
    FillGaps(slices, normal);
  }
  const double count = static_cast<double>(slices.size() - 1);
  const Vector3 step =
    Combine({}, 1.0 / count, Combine(slices.back().Position, -1.0, slices.front().Position));
  const double distance = Dot(step, normal);
  const double smallest = std::min(Length(slices.front().Row), Length(slices.front().Column));
  for (std::size_t i = 1; i < slices.size(); ++i)
  {
    const Vector3 between = Combine(slices[i].Position, -1.0, slices[i - 1].Position);
    RefuseIf(!(Dot(between, normal) > samePlace * distance), slices[i - 1].Name, " and ",
      slices[i].Name,
      " are slices at one place: there are several images (times, echoes, copies), and one can be "
      "read: give the slices of one, in a folder of their own");
  }
  for (std::size_t i = 0; i < slices.size(); ++i)
  {
    const Vector3 place = Combine(slices.front().Position, static_cast<double>(i), step);
    const Vector3 apart = Combine(slices[i].Position, -1.0, place);
    const double along = std::abs(Dot(apart, normal));
    const double inPlane = Length(Combine(apart, -Dot(apart, normal), normal));
    const double deviation = Length(apart);
    RefuseIf(along > tolerated * distance || inPlane > toleratedInPlane * smallest,
      "slices are missing, damaged or not evenly spaced: ", slices[i].Name, " is ", deviation,
      " mm from where slices ", distance, " mm apart put it; complete or resample the series");
  }
  return step;
}

} // namespace voxplex::io
