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
constexpr DICOMTag Organization{ 0x00209311, "Dimension Organization Type" };
constexpr DICOMTag PixelSpacing{ 0x00280030, "Pixel Spacing" };
constexpr DICOMTag RescaleIntercept{ 0x00281052, "Rescale Intercept" };
constexpr DICOMTag RescaleSlope{ 0x00281053, "Rescale Slope" };
constexpr DICOMTag ModalityTable{ 0x00283000, "Modality LUT Sequence" };
constexpr DICOMTag PixelMeasures{ 0x00289110, "Pixel Measures Sequence" };
constexpr DICOMTag PixelTransformation{ 0x00289145, "Pixel Value Transformation Sequence" };
constexpr DICOMTag GridFrameOffsets{ 0x3004000C, "Grid Frame Offset Vector" };
constexpr DICOMTag DoseGridScaling{ 0x3004000E, "Dose Grid Scaling" };
constexpr DICOMTag WholeColumns{ 0x00480006, "Total Pixel Matrix Columns" };
constexpr DICOMTag SegmentIdentification{ 0x0062000A, "Segment Identification Sequence" };
constexpr DICOMTag ReferencedSegment{ 0x0062000B, "Referenced Segment Number" };
constexpr DICOMTag SharedGroups{ 0x52009229, "Shared Functional Groups Sequence" };
constexpr DICOMTag GroupsOfFrames{ 0x52009230, "Per-frame Functional Groups Sequence" };
constexpr DICOMTag FloatPixels{ 0x7FE00008, "Float Pixel Data" };
constexpr DICOMTag DoublePixels{ 0x7FE00009, "Double Float Pixel Data" };
constexpr DICOMTag PixelData{ 0x7FE00010, "Pixel Data" };

/** Of directions, which must have length 1 and be at a right angle, as texts have few digits. */
constexpr double Tolerance = 1e-3;
constexpr double SamePlace = 0.01;        ///< of the distance of slices, or of the size of a voxel
constexpr double ToleratedInPlane = 0.25; ///< of a voxel

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
    std::vector<double> numbers;
    const bool isFound = this->Find(group,
      [&](const DICOMDataSet& item) { return !(numbers = item.Numbers(tag, count)).empty(); });
    return isFound || this->OfFrame ? numbers : this->File.Numbers(tag, count);
  }

  /** @return 0 if it is missing */
  unsigned Short(const DICOMTag& group, const DICOMTag& tag) const
  {
    unsigned number = 0;
    this->Find(
      group, [&](const DICOMDataSet& item) { return (number = item.Short(tag).value_or(0)) > 0; });
    return number;
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
  /** Whether an item has what is looked for. */
  template <typename THas>
  bool Find(const DICOMTag& group, THas&& has) const
  {
    for (const DICOMDataSet* groups : { this->OfFrame, this->Shared })
    {
      const std::vector<DICOMDataSet> items =
        groups ? groups->Items(group) : std::vector<DICOMDataSet>();
      RefuseIf(items.size() > 1, "its ", group, " has several items for a frame");
      if (items.size() == 1 && has(items[0]))
      {
        return true;
      }
    }
    return false;
  }

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
  slice.Segment = groups.Short(SegmentIdentification, ReferencedSegment);
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

/** The distance of slices, from one to the next: as it is told, or else the smallest. They are sorted. */
double FindDistance(const std::vector<DICOMSlice>& slices, const Vector3& normal)
{
  double distance = slices.front().Distance;
  for (std::size_t i = 1; i < slices.size() && slices.front().Distance == 0; ++i)
  {
    const double gap = Dot(Combine(slices[i].Position, -1.0, slices[i - 1].Position), normal);
    distance = i == 1 ? gap : std::min(distance, gap);
  }
  return distance;
}

/** The slices are sorted. */
void FillGaps(
  std::vector<DICOMSlice>& slices, const Vector3& normal, std::vector<std::string>& warnings)
{
  // Few frames must not ask for much memory.
  const double most = std::min(10'000.0, 1'000.0 * static_cast<double>(slices.size()));
  const double distance = FindDistance(slices, normal);
  std::vector<DICOMSlice> all;
  bool areAllApart = true;
  for (const DICOMSlice& slice : slices)
  {
    const DICOMSlice before = all.empty() ? slice : all.back();
    const Vector3 between = Combine(slice.Position, -1.0, before.Position);
    const double gap = Dot(between, normal);
    const double missing = distance > 0 ? std::round(gap / distance) - 1.0 : 0.0;
    RefuseIf(missing + static_cast<double>(all.size()) > most, before.Name, " and ", slice.Name,
      " are ", gap, " mm apart, and its ", SpacingBetweenSlices, " is ", distance,
      (slice.Distance > 0 ? "" : ", by other frames"), ": correct its header");
    areAllApart = areAllApart && (all.empty() || missing > 0);
    for (double i = 1.0; i <= missing; ++i)
    {
      all.push_back(before);
      all.back().Frame = DICOMSlice::NoFrame;
      all.back().Position = Combine(before.Position, i / (missing + 1.0), between);
    }
    all.push_back(slice);
  }
  const bool isTold = slices.front().Distance > 0;
  const bool hasGaps = all.size() > slices.size();
  const bool areThin = slices.front().Thickness > 0 && slices.front().Thickness < 0.9 * distance;
  if (isTold ? areAllApart && slices.size() > 1 : hasGaps || areThin)
  {
    std::ostringstream warning;
    warning << (hasGaps ? "it leaves out slices, " : "its slices are thinner than their distance, ")
            << (isTold       ? "between any two of its frames, by a Spacing Between Slices of "
                   : hasGaps ? "and does not tell their distance, which is taken to be "
                             : "which it does not tell and which is taken to be ")
            << distance << " mm" << (isTold ? "" : ", the smallest of its frames");
    warnings.push_back(warning.str());
  }
  slices = std::move(all);
}

void AddEnds(std::vector<DICOMSlice>& slices, DICOMStack stack, const Vector3& step)
{
  if (stack != DICOMStack::Complete)
  {
    slices.insert(slices.begin(), slices.front());
    slices.push_back(slices.back());
    slices.front().Frame = slices.back().Frame = DICOMSlice::NoFrame;
    slices.front().Position = Combine(slices.front().Position, -1.0, step);
    slices.back().Position = Combine(slices.back().Position, 1.0, step);
  }
}

} // namespace

void CheckObject(const DICOMDataSet& data)
{
  struct Unsuitable
  {
    std::string_view UID;
    const char* Reason;
  };
  constexpr std::array<Unsuitable, 5> unsuitable{ {
    { "1.2.840.10008.1.3.10",
      "a DICOMDIR, which lists other files: give one of these, or the folder of a series" },
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
  RefuseIf(data.Find(WholeColumns) || data.Text(Organization).starts_with("TILED"),
    "its frames are tiles of a picture, as of whole-slide microscopy, and no slices of a volume");
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
  std::vector<DICOMSlice>& slices, DICOMStack stack, std::vector<std::string>& warnings)
{
  constexpr double tolerated = 0.1; // of the distance of slices
  CheckDirections(slices);
  const Vector3 normal = NormalOf(slices.front());
  std::stable_sort(slices.begin(), slices.end(),
    [&normal](const DICOMSlice& a, const DICOMSlice& b)
    { return Dot(a.Position, normal) < Dot(b.Position, normal); });
  const double smallest = std::min(Length(slices.front().Row), Length(slices.front().Column));
  if (stack == DICOMStack::OfSegments)
  {
    const auto isSame = [&](const DICOMSlice& a, const DICOMSlice& b)
    { return Dot(Combine(b.Position, -1.0, a.Position), normal) <= SamePlace * smallest; };
    slices.erase(std::unique(slices.begin(), slices.end(), isSame), slices.end());
  }
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
    const Vector3 step = Combine({}, known == 0 ? Length(only.Row) : known, normal);
    AddEnds(slices, stack, step);
    return step;
  }
  if (stack != DICOMStack::Complete)
  {
    FillGaps(slices, normal, warnings);
  }
  const double count = static_cast<double>(slices.size() - 1);
  const Vector3 step =
    Combine({}, 1.0 / count, Combine(slices.back().Position, -1.0, slices.front().Position));
  const double distance = Dot(step, normal);
  for (std::size_t i = 1; i < slices.size(); ++i)
  {
    const Vector3 between = Combine(slices[i].Position, -1.0, slices[i - 1].Position);
    RefuseIf(!(Dot(between, normal) > SamePlace * distance), slices[i - 1].Name, " and ",
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
    RefuseIf(along > tolerated * distance || inPlane > ToleratedInPlane * smallest,
      "slices are missing, damaged or not evenly spaced: ", slices[i].Name, " is ", deviation,
      " mm from where slices ", distance, " mm apart put it; complete or resample the series");
  }
  AddEnds(slices, stack, step);
  return step;
}

std::size_t FindSlice(
  const std::vector<DICOMSlice>& arranged, const Vector3& step, const DICOMSlice& frame)
{
  const DICOMSlice& first = arranged.front();
  const Vector3 normal = NormalOf(first);
  const double along = Dot(Combine(frame.Position, -1.0, first.Position), normal);
  const auto index = arranged.size() == 3 // one between the ends
    ? std::size_t{ 1 }
    : static_cast<std::size_t>(std::round(along / Dot(step, normal)));
  const DICOMSlice& slice = arranged.at(index);
  const Vector3 apart = Combine(frame.Position, -1.0, slice.Position);
  RefuseIf(Length(apart) > ToleratedInPlane * std::min(Length(first.Row), Length(first.Column)),
    frame.Name, " is ", Length(apart), " mm beside another one, ", slice.Name,
    ", and frames of one volume are above each other: resample it first (3D Slicer)");
  return index;
}

} // namespace voxplex::io
