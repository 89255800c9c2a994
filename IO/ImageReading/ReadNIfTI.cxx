// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Readers.h"

#include "CaretLabels.h"
#include "Fields.h"
#include "Placement.h"
#include "StoredVoxels.h"
#include "Text.h"
#include "TextHeader.h"
#include "Units.h"

#include <vtkMath.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

constexpr std::size_t Size1 = 348;
constexpr std::size_t Size2 = 540;

/** The fields that matter here, of either version. */
struct Header
{
  std::string Path; ///< of the file that it is in
  bool IsBigEndian = false;
  bool IsAnalyze = false; ///< without a magic word
  bool HoldsVoxels = false;
  std::size_t Length = Size1 + 4;      ///< with the four bytes that say whether extensions follow
  std::array<std::int64_t, 8> Sizes{}; ///< [0] is the number of the others that count
  std::int64_t Type = 0;
  std::int64_t BitsPerVoxel = 0;
  std::array<double, 8> Steps{}; ///< [0] is the handedness of the qform
  double Offset = 0.0;
  double Slope = 0.0;
  double Intercept = 0.0;
  double FirstTime = 0.0;
  std::int64_t Units = 0;
  std::int64_t Intent = 0;
  std::int64_t QFormCode = 0;
  std::int64_t SFormCode = 0;
  std::array<double, 6> QForm{}; ///< b, c, d of a quaternion, and the position of the first voxel
  std::array<double, 12> SForm{};
};

/** Of version 1 with numbers of 16 and 32 bits, or of version 2 with wider ones at other places. */
Header Parse(const Fields& fields, bool isFirst)
{
  const auto whole = [&](std::size_t first, std::size_t second) -> std::int64_t
  { return isFirst ? fields.Get<std::int16_t>(first) : fields.Get<std::int32_t>(second); };
  const auto real = [&](std::size_t first, std::size_t second, std::size_t i = 0) -> double
  { return isFirst ? fields.Get<float>(first + 4 * i) : fields.Get<double>(second + 8 * i); };
  Header header;
  const std::string magic = fields.Text(isFirst ? 344 : 4, 3);
  header.Length = isFirst ? Size1 + 4 : Size2 + 4;
  header.IsAnalyze = isFirst && magic != "n+1" && magic != "ni1";
  header.HoldsVoxels = magic == (isFirst ? "n+1" : "n+2");
  for (std::size_t i = 0; i < 8; ++i)
  {
    header.Sizes[i] =
      isFirst ? fields.Get<std::int16_t>(40 + 2 * i) : fields.Get<std::int64_t>(16 + 8 * i);
    header.Steps[i] = real(76, 104, i);
  }
  header.Type = fields.Get<std::int16_t>(isFirst ? 70 : 12);
  header.BitsPerVoxel = fields.Get<std::int16_t>(isFirst ? 72 : 14);
  header.Offset =
    isFirst ? fields.Get<float>(108) : static_cast<double>(fields.Get<std::int64_t>(168));
  if (header.IsAnalyze)
  {
    return header; // whose other fields mean something else
  }
  header.Slope = real(112, 176);
  header.Intercept = real(116, 184);
  header.FirstTime = real(136, 216);
  header.Units = isFirst ? fields.Get<std::uint8_t>(123) : fields.Get<std::int32_t>(500);
  header.Intent = whole(68, 504);
  header.QFormCode = whole(252, 344);
  header.SFormCode = whole(254, 348);
  for (std::size_t i = 0; i < header.QForm.size(); ++i)
  {
    header.QForm[i] = real(256, 352, i);
  }
  for (std::size_t i = 0; i < header.SForm.size(); ++i)
  {
    header.SForm[i] = real(280, 400, i);
  }
  return header;
}

/** The header that a file begins with, packed or not; nothing if there is none. */
std::optional<Header> HeaderIn(const InputFile& file)
{
  const std::string bytes = UnpackBeginning(file, Size2);
  for (const bool isBigEndian : { false, true })
  {
    if (bytes.size() < Size1)
    {
      return std::nullopt;
    }
    const Fields fields(bytes, isBigEndian);
    const std::int32_t size = fields.Get<std::int32_t>(0);
    std::optional<Header> header;
    if (size == Size1)
    {
      header = Parse(fields, true);
      const std::string name = LowerCase(fs::path(file.Path()).filename().string());
      if (header->IsAnalyze && !name.ends_with(".hdr") && !name.ends_with(".hdr.gz"))
      {
        header.reset();
      }
    }
    else if (size == Size2 && bytes.size() >= Size2 &&
      (fields.Text(4, 3) == "n+2" || fields.Text(4, 3) == "ni2"))
    {
      header = Parse(fields, false);
    }
    if (header)
    {
      header->IsBigEndian = isBigEndian;
      header->Path = file.Path();
      return header;
    }
  }
  return std::nullopt;
}

/** The other of two files: x.img for x.hdr, packed or not. Nothing if it is not there. */
std::optional<std::string> FindCompanion(
  const std::string& path, std::string_view from, std::string_view to)
{
  std::string stem = path;
  if (LowerCase(stem).ends_with(".gz"))
  {
    stem.erase(stem.size() - 3);
  }
  const std::string extension = fs::path(stem).extension().string();
  if (LowerCase(extension) != from)
  {
    return std::nullopt;
  }
  std::string other(to);
  if (extension != LowerCase(extension))
  {
    std::transform(other.begin(), other.end(), other.begin(),
      [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  }
  for (const char* packed : { "", ".gz" })
  {
    const std::string companion = fs::path(stem).replace_extension(other).string() + packed;
    std::error_code ignored;
    if (fs::exists(companion, ignored))
    {
      return companion;
    }
  }
  return std::nullopt;
}

/** That of the file, or of the one with the header of an image in two files. */
std::optional<Header> FindHeader(const std::string& path)
{
  std::optional<Header> header = HeaderIn(InputFile(path));
  const std::string other = FindCompanion(path, ".img", ".hdr").value_or("");
  std::error_code ignored;
  if (!header && fs::is_regular_file(other, ignored))
  {
    header = HeaderIn(InputFile(other));
  }
  return header;
}

struct Type
{
  std::int64_t Code;
  std::int64_t Bits;
  ScalarType Scalars;
};

ScalarType TypeOf(const Header& header)
{
  constexpr std::array<Type, 10> types{ { { 2, 8, ScalarType::UInt8 }, { 4, 16, ScalarType::Int16 },
    { 8, 32, ScalarType::Int32 }, { 16, 32, ScalarType::Float32 }, { 64, 64, ScalarType::Float64 },
    { 256, 8, ScalarType::Int8 }, { 512, 16, ScalarType::UInt16 }, { 768, 32, ScalarType::UInt32 },
    { 1024, 64, ScalarType::Int64 }, { 1280, 64, ScalarType::UInt64 } } };
  const auto type = std::find_if(
    types.begin(), types.end(), [&header](const Type& one) { return one.Code == header.Type; });
  RefuseIf(header.Type == 128 || header.Type == 2304, "its voxels are colours (datatype ",
    header.Type, "); a label image has one label a voxel");
  if (type == types.end())
  {
    Refuse(
      "its header gives the datatype ", header.Type, ", which is not a type of single numbers");
  }
  RefuseIf(type->Bits != header.BitsPerVoxel, "its header gives ", header.BitsPerVoxel,
    " bits a voxel (bitpix), and its datatype ", header.Type, " has ", type->Bits);
  return type->Scalars;
}

/** What a voxel is by the intent of the header, if that is several numbers; else empty. */
std::string_view CompoundOf(std::int64_t intent)
{
  static const std::map<std::int64_t, std::string_view> compounds{ { 1004, "matrices" },
    { 1005, "matrices" }, { 1006, "vectors" }, { 1007, "vectors" }, { 1008, "points" },
    { 1009, "triangles" }, { 1010, "quaternions" }, { 2003, "colours" }, { 2004, "colours" },
    // of FSL
    { 2006, "vectors" }, { 2007, "coefficients" }, { 2008, "coefficients" },
    { 2009, "coefficients" }, { 2016, "coefficients" }, { 2017, "coefficients" } };
  const auto compound = compounds.find(intent);
  return compound == compounds.end() ? std::string_view() : compound->second;
}

std::vector<std::int64_t> SizesOf(const Header& header)
{
  constexpr std::int64_t most = 7;
  const std::int64_t count = header.Sizes[0];
  RefuseIf(count < 1 || count > most, "its header gives ", count,
    " dimensions, and the format has 1 to 7");
  std::vector<std::int64_t> sizes{ header.Sizes.begin() + 1, header.Sizes.begin() + 1 + count };
  const std::string_view compound = CompoundOf(header.Intent);
  RefuseIf(!compound.empty() && count > 3 &&
      std::any_of(sizes.begin() + 3, sizes.end(), [](std::int64_t size) { return size > 1; }),
    "its voxels are ", compound, " (intent_code ", header.Intent,
    "), and its further axes are no times; a label image has one label a voxel: export it as a "
    "label map first");
  return sizes;
}

/** From a voxel's indices to RAS, in the header's unit of length. */
struct Affine
{
  std::array<Vector3, 3> Steps{};
  Vector3 Origin{};
};

Affine AffineOfSForm(const Header& header)
{
  Affine affine;
  for (std::size_t row = 0; row < 3; ++row)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      affine.Steps[axis][row] = header.SForm[4 * row + axis];
    }
    affine.Origin[row] = header.SForm[4 * row + 3];
  }
  return affine;
}

void CheckSteps(const Header& header)
{
  for (std::size_t axis = 1; axis <= 3; ++axis)
  {
    const bool counts =
      static_cast<std::int64_t>(axis) <= header.Sizes[0] && header.Sizes[axis] > 1;
    std::ostringstream shown;
    shown << header.Steps[1] << ' ' << header.Steps[2] << ' ' << header.Steps[3];
    CheckSpacing(
      !counts || (header.Steps[axis] > 0 && std::isfinite(header.Steps[axis])), shown.str());
  }
}

/** A spacing; that of an axis with one voxel may be missing. */
double StepOf(const Header& header, std::size_t axis)
{
  const double step = header.Steps[axis + 1];
  return step > 0 && std::isfinite(step) ? step : 1.0;
}

/** The square of a, which the quaternion leaves out. */
double RestOfQuaternion(const Header& header)
{
  const auto [b, c, d, x, y, z] = header.QForm;
  return 1.0 - (b * b + c * c + d * d);
}

/** Its quaternion is not longer than 1. */
bool IsRotation(const Header& header)
{
  constexpr double rounding = 1e-5; // of single-precision numbers
  return RestOfQuaternion(header) >= -rounding;
}

/** The quaternion's rotation, as the standard has it. */
Affine AffineOfQForm(const Header& header)
{
  const auto [b, c, d, x, y, z] = header.QForm;
  const double rest = RestOfQuaternion(header);
  RefuseIf(!IsRotation(header) && !std::isnan(rest), // Place() refuses what is no number
    "the quaternion of its qform is no rotation: correct the header");
  const double a = std::sqrt(std::max(0.0, rest));
  const std::array<double, 4> quaternion{ a, b, c, d };
  double rotation[3][3];
  vtkMath::QuaternionToMatrix3x3(quaternion.data(), rotation); // which makes its length 1
  Affine affine;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double handedness = axis == 2 && header.Steps[0] < 0 ? -1.0 : 1.0;
    for (std::size_t row = 0; row < 3; ++row)
    {
      affine.Steps[axis][row] = rotation[row][axis] * handedness * StepOf(header, axis);
    }
  }
  affine.Origin = { x, y, z };
  return affine;
}

Affine AffineAlongAxes(const Header& header)
{
  Affine affine;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    affine.Steps[axis][axis] = StepOf(header, axis);
  }
  return affine;
}

/** How far apart two affines put a corner of the image at most. */
double DistanceBetween(const Affine& a, const Affine& b, const ScalarImage& image)
{
  double largest = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner)
  {
    Vector3 apart{};
    for (std::size_t row = 0; row < 3; ++row)
    {
      apart[row] = a.Origin[row] - b.Origin[row];
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        const double index = corner >> axis & 1 ? image.Dimensions[axis] - 1 : 0;
        apart[row] += index * (a.Steps[axis][row] - b.Steps[axis][row]);
      }
    }
    largest = std::max(largest, std::hypot(apart[0], apart[1], apart[2]));
  }
  return largest;
}

void WarnIfFormsDiffer(
  const Affine& sform, const Affine& qform, double unit, const ScalarImage& image, Reading& reading)
{
  const double distance = DistanceBetween(sform, qform, image) * unit;
  double spacing = std::numeric_limits<double>::infinity();
  for (const Vector3& step : sform.Steps)
  {
    spacing = std::min(spacing, std::hypot(step[0], step[1], step[2]) * unit);
  }
  constexpr double tolerated = 0.1; // of a voxel; forms are single-precision numbers
  if (!(distance <= tolerated * spacing))
  {
    std::ostringstream warning;
    warning.precision(3);
    warning << "its header gives two places, and the sform is used; the qform puts a corner "
            << distance << " mm from there: if that is right, set the sform's code to 0";
    reading.Warnings.push_back(warning.str());
  }
}

Affine FindAffine(const Header& header, double unit, const ScalarImage& image, Reading& reading)
{
  if (header.SFormCode > 0)
  {
    const Affine sform = AffineOfSForm(header);
    if (header.QFormCode > 0 && !IsRotation(header))
    {
      reading.Warnings.push_back("its header gives two places, and the sform is used; the qform is "
                                 "no rotation: set its code to 0");
    }
    else if (header.QFormCode > 0)
    {
      WarnIfFormsDiffer(sform, AffineOfQForm(header), unit, image, reading);
    }
    return sform;
  }
  CheckSteps(header);
  if (header.QFormCode > 0)
  {
    return AffineOfQForm(header);
  }
  reading.PlaceGuesses.push_back(header.IsAnalyze
      ? "the format ANALYZE does not say how an image lies: its axes are taken for those of LPS"
      : "its header does not say where the image lies (qform and sform have the code 0): its axes "
        "are taken for those of RAS, from 0 on");
  return AffineAlongAxes(header);
}

/** Into millimetres, from metres and micrometres. */
double UnitOfLength(const Header& header, Reading& reading)
{
  const std::int64_t code = header.Units & 7;
  WarnOfLengths(code > 3 ? "unit " + std::to_string(code) : "", reading);
  return code == 1 ? 1e3 : code == 3 ? 1e-3 : 1.0;
}

/** Into seconds, from milliseconds and microseconds. */
double UnitOfTime(const Header& header, Reading& reading)
{
  const std::int64_t code = header.Units & 56;
  static const std::map<std::int64_t, const char*> others{ { 32, "Hz" }, { 40, "ppm" },
    { 48, "rad/s" }, { 56, "unit 56" } };
  if (const auto other = others.find(code); other != others.end())
  {
    WarnOfTimes(other->second, reading);
  }
  return code == 16 ? 1e-3 : code == 24 ? 1e-6 : 1.0;
}

void PlaceImage(const Header& header, ScalarImage& image, Reading& reading)
{
  const double unit = UnitOfLength(header, reading);
  Affine affine = FindAffine(header, unit, image, reading);
  // From RAS to LPS, but what ANALYZE does not say.
  const Vector3 signs = header.IsAnalyze ? Vector3{ 1.0, 1.0, 1.0 } : Vector3{ -1.0, -1.0, 1.0 };
  for (std::size_t row = 0; row < 3; ++row)
  {
    affine.Origin[row] *= signs[row] * unit;
    for (Vector3& step : affine.Steps)
    {
      step[row] *= signs[row] * unit;
    }
  }
  Place(image, affine.Steps, affine.Origin);
}

void AdoptTimes(const Header& header, ScalarImage& image, Reading& reading)
{
  const double unit = UnitOfTime(header, reading);
  const double step = header.Steps[4] * unit;
  RefuseIf(!std::isfinite(header.FirstTime),
    "the time of the first frame in its header (toffset) is not a finite number: correct the "
    "header");
  if (step == 0)
  {
    reading.Warnings.push_back("its header has 0 for the time from frame to frame, which is taken "
                               "to be 1; use SetTimeScale() to weigh time against space");
  }
  std::ostringstream shown;
  shown << header.Steps[4];
  SetTimeStep(image, header.FirstTime * unit, step == 0 ? 1.0 : step, shown.str());
}

StoredVoxels FindVoxels(const Header& header, const Reading& reading)
{
  StoredVoxels stored;
  stored.IsBigEndian = header.IsBigEndian;
  const std::string& path = header.Path;
  std::string voxels = path;
  if (!header.HoldsVoxels)
  {
    voxels = FindCompanion(path, ".hdr", ".img").value_or("");
    RefuseIf(voxels.empty(), "its voxels are in another file, '",
      fs::path(path).stem().replace_extension(".img").string(), "', which is not beside it");
    voxels =
      FindDataFile(path, fs::path(voxels).filename().string(), reading.Request.DataFilesAnywhere);
  }
  constexpr double largest = 1e15;
  const double least = header.HoldsVoxels ? static_cast<double>(header.Length) : 0.0;
  RefuseIf(!(header.Offset >= least || (header.Offset == 0 && !header.HoldsVoxels)) ||
      !(header.Offset <= largest),
    "its header says that voxels begin at byte ", header.Offset,
    " (vox_offset), which is within the header or nowhere");
  stored.Files = { voxels };
  stored.Coding = InputFile(voxels).Beginning(2) == "\x1f\x8b" ? Encoding::Deflate : Encoding::Raw;
  stored.BytesToSkip = static_cast<std::int64_t>(header.Offset);
  return stored;
}

/** Names of labels, in an extension that lies between the header and the voxels. A damaged one is left out. */
void ReadExtensions(const Header& header, Reading& reading)
{
  constexpr std::size_t most = 1 << 26;
  const InputFile file(header.Path);
  const std::size_t end =
    header.HoldsVoxels ? std::min(most, static_cast<std::size_t>(header.Offset)) : most;
  const std::string bytes = UnpackBeginning(file, end);
  const Fields fields(bytes, header.IsBigEndian);
  std::size_t at = header.Length;
  if (header.IsAnalyze || bytes.size() < at + 8 || bytes[at - 4] == 0)
  {
    return;
  }
  try
  {
    while (reading.Labels.Entries.empty() && at + 8 <= bytes.size())
    {
      const std::int32_t size = fields.Get<std::int32_t>(at);
      RefuseIf(size < 8 || static_cast<std::size_t>(size) > bytes.size() - at, "it has ", size,
        " bytes, and the header ", bytes.size() - at, " for it");
      reading.Labels = ParseCaretLabels(
        std::string_view(bytes).substr(at + 8, static_cast<std::size_t>(size) - 8));
      at += static_cast<std::size_t>(size);
    }
  }
  catch (const FileError& error)
  {
    reading.Warnings.push_back(
      std::string("an extension of its header, which may hold names of labels, is damaged: ") +
      error.what());
  }
}

} // namespace

bool IsNIfTI(const InputFile& file)
{
  return FindHeader(file.Path()).has_value();
}

ScalarImage ReadNIfTI(const std::string& path, Reading& reading)
{
  const std::optional<Header> header = FindHeader(path);
  RefuseIf(!header, "it has no header of NIfTI");
  ScalarImage image;
  image.Type = TypeOf(*header);
  SetSizes(image, SizesOf(*header));
  PlaceImage(*header, image, reading);
  if (image.Frames > 1)
  {
    AdoptTimes(*header, image, reading);
  }
  ReadVoxels(FindVoxels(*header, reading), image, reading);
  ReadExtensions(*header, reading);
  const bool isScaled =
    header->Slope != 0 && std::isfinite(header->Slope) && std::isfinite(header->Intercept);
  if (isScaled)
  {
    Rescale(image, header->Slope, header->Intercept, reading);
  }
  return image;
}

} // namespace voxplex::io
