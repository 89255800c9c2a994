// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "Placement.h"
#include "Segments.h"
#include "StoredVoxels.h"
#include "Text.h"
#include "TextHeader.h"
#include "Units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

namespace voxplex::io
{
namespace
{

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
/** Header fields have few digits; a direction is taken for what it is meant to be up to this. */
constexpr double DirectionTolerance = 1e-5;

/** How coordinates of a space become LPS. */
struct Space
{
  Vector3 Signs{ 1.0, 1.0, 1.0 };
  std::size_t Dimension = 0; ///< 0: there is no space
  bool SaysWhereLeftIs = true;
};

struct Axis
{
  std::int64_t Size = 0;
  std::string Kind;              ///< lower case; empty if not given
  std::vector<double> Direction; ///< its space direction; empty if there is none
  double Spacing = NaN;
  double First = NaN; ///< position of its first sample
};

constexpr TypeNames Types{
  "|signed char|int8|int8_t|",
  "|uchar|unsigned char|uint8|uint8_t|",
  "|short|short int|signed short|signed short int|int16|int16_t|",
  "|ushort|unsigned short|unsigned short int|uint16|uint16_t|",
  "|int|signed int|int32|int32_t|",
  "|uint|unsigned int|uint32|uint32_t|",
  "|longlong|long long|long long int|signed long long|signed long long int|int64|int64_t|",
  "|ulonglong|unsigned long long|unsigned long long int|uint64|uint64_t|",
  "|float|",
  "|double|",
};

/** Words may be joined by anything: Teem writes "left-posterior-superior", and reads "left posterior superior", too. */
Space SpaceNamed(const std::string& text)
{
  static const std::map<std::string, Space> spaces{
    { "rightanteriorsuperior", { { -1, -1, 1 }, 3 } },
    { "ras", { { -1, -1, 1 }, 3 } },
    { "leftanteriorsuperior", { { 1, -1, 1 }, 3 } },
    { "las", { { 1, -1, 1 }, 3 } },
    { "leftposteriorsuperior", { { 1, 1, 1 }, 3 } },
    { "lps", { { 1, 1, 1 }, 3 } },
    { "scannerxyz", { { 1, 1, 1 }, 3, false } },
    { "3drighthanded", { { 1, 1, 1 }, 3, false } },
    { "3dlefthanded", { { 1, 1, 1 }, 3, false } },
  };
  std::string name = LowerCase(text);
  std::erase_if(name, [](char c) { return c == '-' || c == '_' || c == ' '; });
  for (const std::string_view end : { "", "time", "t" })
  {
    const auto space =
      name.ends_with(end) ? spaces.find(name.substr(0, name.size() - end.size())) : spaces.end();
    if (space != spaces.end())
    {
      Space result = space->second;
      result.Dimension = end.empty() ? 3 : 4;
      return result;
    }
  }
  Refuse("its header gives the space '", Excerpt(text),
    "', which NRRD does not have: correct the header");
}

Space FindSpace(const TextHeader& header)
{
  if (const std::string* name = header.Find("space"))
  {
    return SpaceNamed(*name);
  }
  const std::int64_t dimension = header.Whole({ "space dimension" }, 0);
  RefuseIf(dimension != 0 && dimension != 3 && dimension != 4, "its space has ", dimension,
    " dimensions; voxplex meshes images in three, and in four with time as the last");
  return { { 1, 1, 1 }, static_cast<std::size_t>(dimension), false };
}

/** A field with another name may be a misspelt one that matters. */
void CheckFields(const TextHeader& header)
{
  static const std::set<std::string> known{ "axis maxs", "axis mins", "axismaxs", "axismins",
    "block size", "blocksize", "byte skip", "byteskip", "centerings", "centers", "content",
    "data file", "datafile", "dimension", "encoding", "endian", "kinds", "labels", "line skip",
    "lineskip", "max", "measurement frame", "min", "number", "old max", "old min", "oldmax",
    "oldmin", "sample units", "sampleunits", "sizes", "space", "space dimension",
    "space directions", "space origin", "space units", "spacings", "thicknesses", "type", "units" };
  for (const auto& [key, spelling] : header.Own())
  {
    const bool isPair = header.Find(key)->find(":=") != std::string::npos; // "a: b:=c"
    RefuseIf(!known.contains(key) && !isPair, "its header gives '", Excerpt(spelling),
      "', which is no field of NRRD: correct the header");
  }
}

// --- Axes --------------------------------------------------------------------------------------------

/** "none (1,0,0) (0, 1, 0)": the vectors, empty for "none" and for one of NaN. */
std::vector<std::vector<double>> ParseVectors(const std::string& text, std::size_t dimension)
{
  std::vector<std::vector<double>> vectors;
  for (std::size_t at = 0; (at = text.find_first_not_of(" \t", at)) != std::string::npos;)
  {
    const bool isVector = text[at] == '(';
    const std::size_t end = std::min(text.find_first_of(isVector ? ")" : " \t", at), text.size());
    std::vector<double> vector =
      isVector ? ParseNumbers(text.substr(at, end - at)) : std::vector<double>();
    if (std::all_of(vector.begin(), vector.end(), [](double number) { return std::isnan(number); }))
    {
      vector.clear();
    }
    RefuseIf(!vector.empty() && vector.size() != dimension,
      "its header gives a space direction of ", vector.size(), " numbers in a space of ", dimension,
      " dimensions: correct the header");
    vectors.push_back(std::move(vector));
    at = std::min(end + 1, text.size());
  }
  return vectors;
}

/** One for each axis. */
template <typename T>
void CheckLength(const std::vector<T>& values, const std::vector<Axis>& axes, const char* field)
{
  RefuseIf(values.size() != axes.size(), "its header has ", axes.size(), " axes, and ",
    values.size(), " of '", field, "': correct the header");
}

/** A word for each axis; empty if the field is not there. */
std::vector<std::string> AxisWords(
  const TextHeader& header, std::initializer_list<const char*> keys, const std::vector<Axis>& axes)
{
  const std::string text = header.Word(keys, "");
  const std::vector<std::string_view> words = Words(text);
  if (header.FindAny(keys))
  {
    CheckLength(words, axes, *keys.begin());
  }
  return { words.begin(), words.end() };
}

std::vector<Axis> ReadAxes(const TextHeader& header, const Space& space)
{
  const std::int64_t dimension = header.Whole({ "dimension" }, 0);
  constexpr std::int64_t most = 16; // which NRRD has
  RefuseIf(dimension < 1 || dimension > most, "its header gives ", dimension,
    " dimensions, and NRRD has 1 to 16");
  std::vector<Axis> axes(static_cast<std::size_t>(dimension));
  const std::vector<std::int64_t> sizes = header.Wholes({ "sizes" }, axes.size());
  RefuseIf(sizes.empty(), "its header does not give 'sizes'");
  const std::vector<std::string> kinds = AxisWords(header, { "kinds" }, axes);
  const std::vector<std::string> centers = AxisWords(header, { "centers", "centerings" }, axes);
  std::vector<std::vector<double>> directions;
  if (const std::string* text = header.Find("space directions"))
  {
    directions = ParseVectors(*text, space.Dimension);
    CheckLength(directions, axes, "space directions");
  }
  const std::vector<double> spacings = header.Numbers({ "spacings" }, axes.size());
  const std::vector<double> mins = header.Numbers({ "axis mins", "axismins" }, axes.size());
  const std::vector<double> maxs = header.Numbers({ "axis maxs", "axismaxs" }, axes.size());
  for (std::size_t a = 0; a < axes.size(); ++a)
  {
    Axis& axis = axes[a];
    axis.Size = sizes[a];
    axis.Kind = kinds.empty() || kinds[a] == "???" || kinds[a] == "none" ? "" : kinds[a];
    axis.Direction = directions.empty() ? std::vector<double>() : directions[a];
    const bool isNode = !centers.empty() && centers[a] == "node"; // NRRD's default is cell
    const double steps = static_cast<double>(axis.Size) - (isNode ? 1.0 : 0.0);
    const double range = mins.empty() || maxs.empty() ? NaN : (maxs[a] - mins[a]) / steps;
    axis.Spacing = spacings.empty() ? range : spacings[a];
    const double step = std::isnan(axis.Spacing) ? 1.0 : axis.Spacing;
    axis.First = mins.empty() ? NaN : mins[a] + (isNode ? 0.0 : step / 2.0);
  }
  return axes;
}

/** Which axes are those of space, in the order of the file, and which one is that of frames. */
struct Roles
{
  std::vector<std::size_t> Space;
  std::optional<std::size_t> Frames;
  bool HasLayers = false; ///< of segments, in place of frames
};

bool IsAlongTime(const std::vector<double>& direction)
{
  return direction.size() == 4 && direction[3] != 0 &&
    std::all_of(direction.begin(), direction.begin() + 3,
      [](double number) { return std::abs(number) < DirectionTolerance; });
}

/** NRRD's kinds of axes along which samples have places. */
bool IsDomain(const Axis& axis)
{
  return axis.Kind.empty() || axis.Kind == "domain" || axis.Kind == "space" || axis.Kind == "time";
}

[[noreturn]] void RefuseComponents(const std::vector<Axis>& axes, std::size_t axis)
{
  Refuse("it has ", axes[axis].Size,
    " components a voxel (colours or vectors); a label image has one: export it as a label map "
    "first, or, if they are time frames, save an image of four dimensions, or give their axis (",
    axis, ") the kind 'list'");
}

Roles AssignRoles(const TextHeader& header, const std::vector<Axis>& axes, const Space& space)
{
  Roles roles;
  const bool hasDirections = header.Find("space directions") != nullptr;
  std::vector<std::size_t> others;
  for (std::size_t a = 0; a < axes.size(); ++a)
  {
    const Axis& axis = axes[a];
    const bool isTime = axis.Kind == "time" || IsAlongTime(axis.Direction);
    const bool isOfSpace = hasDirections ? !axis.Direction.empty() : IsDomain(axis);
    (isOfSpace && !isTime ? roles.Space : others).push_back(a);
  }
  // Without any hint, the last of four axes is that of time.
  if (!hasDirections && others.empty() && roles.Space.size() == 4)
  {
    others.push_back(roles.Space.back());
    roles.Space.pop_back();
  }
  for (const std::size_t a : others)
  {
    const bool isTime = axes[a].Kind == "time" || axes[a].Kind == "list" ||
      IsAlongTime(axes[a].Direction) || (!hasDirections && IsDomain(axes[a]));
    if (axes[a].Size == 1)
    {
      continue; // one frame, or one component
    }
    RefuseIf(!isTime && axes[a].Kind.empty() && space.Dimension > 0,
      "its header gives no space direction to axis ", a, ", which has ", axes[a].Size,
      " samples: if they are time frames, give that axis the kind 'list', or use a space of four "
      "dimensions such as left-posterior-superior-time");
    const bool isSequence = header.FindPair("axis " + std::to_string(a) + " index values");
    roles.HasLayers = (!isTime || (axes[a].Kind == "list" && !isSequence)) && HasSegments(header);
    if (!isTime && !roles.HasLayers)
    {
      RefuseComponents(axes, a);
    }
    RefuseIf(roles.Frames.has_value(), "it has ", axes.size(),
      " dimensions; voxplex meshes images of three, and of four with time as one: extract one of "
      "those first");
    roles.Frames = a;
  }
  CheckTimeIsApart(space.Dimension != 4 || roles.Space.size() != 4);
  while (roles.Space.size() > 3 && axes[roles.Space.back()].Size == 1)
  {
    roles.Space.pop_back();
  }
  RefuseIf(roles.Space.size() != 3, "it has ", roles.Space.size(),
    " axes of space; a volume has three: give a volume");
  return roles;
}

// --- Units -------------------------------------------------------------------------------------------

/** "mm" "mm" "mm" "s": the texts within quotes. */
std::vector<std::string> UnitsIn(const TextHeader& header, const char* field)
{
  const std::string* const text = header.Find(field);
  const std::vector<std::string> parts = Split(text ? *text : "", '"');
  std::vector<std::string> units;
  for (std::size_t i = 1; i < parts.size(); i += 2)
  {
    units.push_back(parts[i] == "???" ? "" : parts[i]);
  }
  return units;
}

std::string UnitAt(const std::vector<std::string>& units, std::size_t axis)
{
  return axis < units.size() ? units[axis] : "";
}

/** Along the axes of space, if it gives units of them, else along those of the file. */
Vector3 FactorsOfUnits(const TextHeader& header, const Roles& roles, Reading& reading)
{
  const std::vector<std::string> ofSpace = UnitsIn(header, "space units");
  const std::vector<std::string> ofAxes = UnitsIn(header, "units");
  std::array<std::string, 3> units;
  for (std::size_t i = 0; i < 3; ++i)
  {
    units[i] = ofSpace.empty() ? UnitAt(ofAxes, roles.Space[i]) : UnitAt(ofSpace, i);
  }
  WarnOfLengths(units[0], reading);
  return ToUnitOfFirst(units, reading);
}

/** 3D Slicer's sequences have "axis 0 index unit:=ms". */
std::string UnitOfTime(const TextHeader& header, const Axis& axis, std::size_t number)
{
  if (const std::string* unit = header.FindPair("axis " + std::to_string(number) + " index unit"))
  {
    return *unit;
  }
  const std::string own = UnitAt(UnitsIn(header, "units"), number);
  const bool isInSpace = axis.Direction.size() == 4;
  return own.empty() && isInSpace ? UnitAt(UnitsIn(header, "space units"), 3) : own;
}

// --- Placement ---------------------------------------------------------------------------------------

/** By space directions, or else by spacings along the axes of the space, which may be that of a header without one. */
void PlaceImage(const TextHeader& header, const std::vector<Axis>& axes, const Roles& roles,
  const Space& space, ScalarImage& image, Reading& reading)
{
  const bool hasDirections = header.Find("space directions") != nullptr;
  const bool hasSpacings = header.FindAny({ "spacings", "axis maxs", "axismaxs" }) != nullptr;
  const bool hasSpaceUnits = header.Find("space units") != nullptr;
  const std::vector<double> given = header.Numbers({ "space origin" }, space.Dimension);
  const Vector3 factors = FactorsOfUnits(header, roles, reading);
  bool hasOrigin = true;
  Vector3 origin{};
  std::array<Vector3, 3> steps{};
  for (std::size_t i = 0; i < 3; ++i)
  {
    const Axis& axis = axes[roles.Space[i]];
    const double first = !given.empty() ? given[i] : hasDirections ? NaN : axis.First;
    const bool isMissing = std::isnan(first) && (given.empty() || !hasDirections);
    const double factor = hasSpaceUnits || !hasDirections ? factors[i] : 1.0;
    hasOrigin = hasOrigin && !isMissing && !std::isnan(first);
    origin[i] = isMissing ? 0.0 : space.Signs[i] * first * factor;
    if (!hasDirections)
    {
      CheckSpacing(!hasSpacings || (axis.Spacing > 0 && std::isfinite(axis.Spacing)),
        header.Shown({ "spacings", "axis maxs", "axismaxs" }));
      steps[i][i] = space.Signs[i] * (hasSpacings ? axis.Spacing * factor : 1.0);
      continue;
    }
    const std::vector<double>& direction = axis.Direction;
    CheckSpacing(std::all_of(direction.begin(), direction.end(),
                   [](double number) { return std::isfinite(number); }),
      header.Shown({ "space directions" }));
    CheckTimeIsApart(direction.size() != 4 || std::abs(direction[3]) < DirectionTolerance);
    for (std::size_t row = 0; row < 3; ++row)
    {
      steps[i][row] = space.Signs[row] * direction[row] * factors[hasSpaceUnits ? row : i];
    }
  }
  Place(image, steps, origin);
  reading.HasPlace = hasOrigin;
  if (!hasDirections && !hasSpacings)
  {
    WarnOfSpacing(reading);
  }
  if (hasDirections && !space.SaysWhereLeftIs)
  {
    reading.Warnings.push_back(
      "its header does not say where left, posterior and superior are (space '" +
      Excerpt(header.Word({ "space" }, "none")) + "'); its coordinates are taken for LPS");
  }
}

// --- Frames ------------------------------------------------------------------------------------------

/** What 3D Slicer's sequences have: "axis 0 index values:=0 0.04 0.08". */
bool AdoptIndexValues(
  const TextHeader& header, std::size_t axis, ScalarImage& image, Reading& reading)
{
  const std::string key = "axis " + std::to_string(axis) + " index ";
  const std::string* values = header.FindPair(key + "values");
  if (!values)
  {
    return false;
  }
  const std::string* type = header.FindPair(key + "type");
  const std::vector<double> times = ParseNumbers(*values);
  const bool isFinite =
    std::all_of(times.begin(), times.end(), [](double time) { return std::isfinite(time); });
  if (times.size() != static_cast<std::size_t>(image.Frames) || !isFinite ||
    (type && *type == "text"))
  {
    reading.Warnings.push_back(
      "its '" + key + "values' are not one number for each frame, and are not used");
    return false;
  }
  SetFrameTimes(image, times);
  return true;
}

void AdoptTimes(const TextHeader& header, const Axis& axis, std::size_t number, ScalarImage& image,
  Reading& reading)
{
  WarnOfTimes(UnitOfTime(header, axis, number), reading);
  if (AdoptIndexValues(header, number, image, reading))
  {
    return;
  }
  const bool isInSpace = axis.Direction.size() == 4;
  const double step = isInSpace ? axis.Direction[3] : axis.Spacing;
  RefuseIf(
    isInSpace && step < 0, "its time runs backwards: reverse the frames, or correct the header");
  const std::vector<double> origin =
    isInSpace ? header.Numbers({ "space origin" }, 4) : std::vector<double>();
  const double first = !origin.empty() && !std::isnan(origin[3]) ? origin[3] : axis.First;
  SetTimeStep(image, std::isnan(first) ? 0.0 : first, std::isnan(step) ? 1.0 : step,
    header.Shown({ isInSpace ? "space directions" : "spacings", "axis maxs", "axismaxs" }));
}

/** @param size of a voxel in bytes */
StoredVoxels FindVoxels(const TextHeader& header, std::size_t size, const Reading& reading)
{
  StoredVoxels stored;
  static const std::map<std::string, Encoding> encodings{ { "raw", Encoding::Raw },
    { "gz", Encoding::Deflate }, { "gzip", Encoding::Deflate }, { "txt", Encoding::Text },
    { "text", Encoding::Text }, { "ascii", Encoding::Text }, { "hex", Encoding::Hex } };
  const std::string name = header.Word({ "encoding" }, "");
  const auto encoding = encodings.find(name);
  RefuseIf(encoding == encodings.end(),
    name.empty() ? "its header gives no encoding"
                 : "its voxels are in the encoding '" + Excerpt(name) + "'",
    "; those that are read are raw, gzip, text and hex: save it with one of these");
  stored.Coding = encoding->second;
  const std::string endian = header.Word(
    { "endian" }, stored.Coding == Encoding::Text || size == 1 ? "little" : "not given");
  RefuseIf(endian != "little" && endian != "big", "its header gives the byte order '",
    Excerpt(endian), "', which is neither little nor big ('endian'): correct the header");
  stored.IsBigEndian = endian == "big";
  stored.LinesToSkip = header.Whole({ "line skip", "lineskip" }, 0);
  stored.BytesToSkip = header.Whole({ "byte skip", "byteskip" }, 0);
  const bool isRaw = stored.Coding == Encoding::Raw;
  RefuseIf(stored.LinesToSkip < 0 || stored.BytesToSkip < (isRaw ? StoredVoxels::FromTheEnd : 0),
    "its header skips less than nothing ('line skip' or 'byte skip'): correct the header");
  header.SetFiles(
    header.FindAny({ "data file", "datafile" }), reading.Request.DataFilesAnywhere, stored);
  return stored;
}

} // namespace

bool IsNRRD(const InputFile& file)
{
  return file.Beginning(4) == "NRRD";
}

ScalarImage ReadNRRD(const std::string& path, Reading& reading)
{
  const InputFile file(path);
  const TextHeader header(file);
  CheckFields(header);
  const Space space = FindSpace(header);
  const std::vector<Axis> axes = ReadAxes(header, space);
  const Roles roles = AssignRoles(header, axes, space);

  ScalarImage image;
  image.Type = TypeNamed(header.Word({ "type" }, ""), "type", Types);
  std::vector<std::int64_t> sizes;
  for (const std::size_t a : roles.Space)
  {
    sizes.push_back(axes[a].Size);
  }
  if (roles.Frames)
  {
    sizes.push_back(axes[*roles.Frames].Size);
  }
  SetSizes(image, sizes);
  PlaceImage(header, axes, roles, space, image, reading);
  if (roles.Frames && !roles.HasLayers)
  {
    AdoptTimes(header, axes[*roles.Frames], *roles.Frames, image, reading);
  }
  ReadVoxels(FindVoxels(header, SizeOf(image.Type), reading), image, reading);
  if (roles.Frames)
  {
    const auto before = static_cast<std::size_t>(std::count_if(roles.Space.begin(),
      roles.Space.end(), [&roles](std::size_t a) { return a < *roles.Frames; }));
    MoveFramesToTheEnd(image, before, reading);
  }
  if (roles.HasLayers)
  {
    return CombineLayers(header, image, reading);
  }
  reading.Labels = ReadSegments(header, reading.Warnings);
  return image;
}

} // namespace voxplex::io
