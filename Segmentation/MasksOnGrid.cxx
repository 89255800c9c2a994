// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MasksOnGrid.h"

#include "Geometry/SimplexQuality.h"
#include "Placement.h"
#include "Refuse.h"
#include "ShownText.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <sstream>

namespace voxplex
{
namespace
{

/** How far voxels may be apart that are meant to be one, in voxels: some headers have single precision. */
constexpr double Tolerance = 0.01;

/** A grid is extended to so many voxels (2 GiB), or to so many times those of the largest mask. */
constexpr double MostVoxels = 1 << 30;
constexpr double MostTimes = 8;

/** From indices of a grid to places, or to indices of another grid. */
struct Affine
{
  std::array<Vector3, 3> Steps{ { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }; ///< along each axis
  Vector3 First{};

  Vector3 At(double i, double j, double k) const
  {
    Vector3 at;
    for (std::size_t row = 0; row < 3; ++row)
    {
      at[row] = this->Steps[0][row] * i + this->Steps[1][row] * j + this->Steps[2][row] * k +
        this->First[row];
    }
    return at;
  }
  bool operator==(const Affine&) const = default;
};

Affine PlacesOf(const ScalarImage& image)
{
  return { StepsOf(image), image.Origin };
}

/** From the lowest to the highest coordinates of an image, further out by so many voxels. */
std::array<Vector3, 2> BoxOf(const ScalarImage& image, const Affine& fromIndices, double further)
{
  std::array<Vector3, 2> box;
  box[0].fill(std::numeric_limits<double>::infinity());
  box[1].fill(-std::numeric_limits<double>::infinity());
  for (int corner = 0; corner < 8; ++corner)
  {
    const auto end = [&](std::size_t axis)
    { return (corner >> axis & 1) != 0 ? image.Dimensions[axis] - 1 + further : -further; };
    const Vector3 at = fromIndices.At(end(0), end(1), end(2));
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      box[0][axis] = std::min(box[0][axis], at[axis]);
      box[1][axis] = std::max(box[1][axis], at[axis]);
    }
  }
  return box;
}

/** The translation that is nearest to one between indices. */
Affine WholeSteps(const Affine& map)
{
  Affine steps;
  std::transform(map.First.begin(), map.First.end(), steps.First.begin(),
    [](double step) { return std::round(step); });
  return steps;
}

/** From indices of a mask to those of a grid: whole steps, exactly, if they are on one lattice. */
Affine MapBetween(const ScalarImage& mask, const ScalarImage& grid)
{
  const Affine to = PlacesOf(grid);
  Affine map = PlacesOf(mask);
  map.First = Subtract(map.First, to.First);
  const auto normal = [&to](std::size_t axis)
  { return Cross(to.Steps[(axis + 1) % 3], to.Steps[(axis + 2) % 3]); };
  const std::array<Vector3, 3> normals{ normal(0), normal(1), normal(2) };
  const double volume = Dot(to.Steps[0], normals[0]);
  for (Vector3* const vector : { &map.Steps[0], &map.Steps[1], &map.Steps[2], &map.First })
  {
    *vector = { Dot(normals[0], *vector) / volume, Dot(normals[1], *vector) / volume,
      Dot(normals[2], *vector) / volume };
  }
  const Affine steps = WholeSteps(map);
  Affine rest;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    rest.Steps[axis] = Subtract(map.Steps[axis], steps.Steps[axis]);
  }
  rest.First = Subtract(map.First, steps.First);
  for (const Vector3& apart : BoxOf(mask, rest, 0))
  {
    if (!std::all_of(apart.begin(), apart.end(),
          [](double distance) { return std::abs(distance) <= Tolerance; }))
    {
      return map;
    }
  }
  return steps;
}

bool AreOnOneLattice(const ScalarImage& mask, const ScalarImage& grid)
{
  const Affine map = MapBetween(mask, grid);
  return map == WholeSteps(map);
}

std::string Listed(const auto& numbers)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    text << (i > 0 ? " " : "") << numbers[i];
  }
  return text.str();
}

void RefuseOther(const ScalarImage& a, const std::string& shownOfA, const ScalarImage& b,
  const std::string& shownOfB)
{
  const auto differs = [](const auto& these, const auto& those, double tolerance)
  {
    for (std::size_t i = 0; i < these.size(); ++i)
    {
      if (!(std::abs(these[i] - those[i]) <= tolerance))
      {
        return true;
      }
    }
    return false;
  };
  const auto refuse = [&](const char* what, const auto& first, const auto& second)
  {
    Refuse("masks must be on one grid, but ", shownOfA, " has the ", what, ' ', Listed(first),
      ", and ", shownOfB, ' ', Listed(second),
      "; give ResampleMasksOn() to resample them to the finest grid, by nearest neighbour");
  };
  const double smallest = *std::min_element(a.Spacing.begin(), a.Spacing.end());
  const double steps = *std::max_element(a.Dimensions.begin(), a.Dimensions.end());
  if (differs(a.Spacing, b.Spacing, Tolerance * smallest / steps))
  {
    refuse("spacing", a.Spacing, b.Spacing);
  }
  if (differs(a.Direction, b.Direction, Tolerance / steps))
  {
    refuse("direction", a.Direction, b.Direction);
  }
  refuse("origin", a.Origin, b.Origin);
}

double VoxelVolume(const ScalarImage& image)
{
  return image.Spacing[0] * image.Spacing[1] * image.Spacing[2] * VolumeOfDirections(image);
}

/** Voxels of a mask whose centres are in no voxel of a grid. */
std::uint64_t CountBeyond(const ScalarImage& mask, const ScalarImage& grid, double threshold)
{
  const Affine map = MapBetween(mask, grid);
  return Dispatch(mask.Type,
    [&](auto zero)
    {
      using T = decltype(zero);
      const T* voxel = static_cast<const T*>(mask.Scalars.get());
      std::uint64_t count = 0;
      for (int k = 0; k < mask.Dimensions[2]; ++k)
      {
        for (int j = 0; j < mask.Dimensions[1]; ++j)
        {
          for (int i = 0; i < mask.Dimensions[0]; ++i, ++voxel)
          {
            if (IsInside(*voxel, threshold))
            {
              const Vector3 index = map.At(i, j, k);
              bool isBeyond = false;
              for (std::size_t axis = 0; axis < 3; ++axis)
              {
                isBeyond =
                  isBeyond || index[axis] < -0.5 || index[axis] > grid.Dimensions[axis] - 0.5;
              }
              count += isBeyond;
            }
          }
        }
      }
      return count;
    });
}

/** Whether the middle of two voxels is meant. Some headers have single precision. */
bool IsTie(double index)
{
  constexpr double tolerance = 1e-4;
  return std::abs(index - std::floor(index) - 0.5) < tolerance;
}

/** Of two that are as near the even one, so that faces do not all move to one side. */
int Nearest(double index)
{
  return static_cast<int>(
    IsTie(index) ? std::nearbyint(std::floor(index) + 0.5) : std::round(index));
}

/** Whether voxels of a grid lie in the middle between those of a mask along an axis of both. */
bool HasTies(const ScalarImage& mask, const ScalarImage& grid)
{
  const Affine map = MapBetween(grid, mask);
  for (std::size_t row = 0; row < 3; ++row)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double step = map.Steps[axis][row];
      const double others =
        std::abs(map.Steps[(axis + 1) % 3][row]) + std::abs(map.Steps[(axis + 2) % 3][row]);
      const int size = grid.Dimensions[axis];
      for (int i = 0; others * MostVoxels < 1.0 && step != 0 && i < size; ++i)
      {
        if (IsTie(map.First[row] + i * step))
        {
          return true;
        }
      }
    }
  }
  return false;
}

/** What a row of a grid adds to the number of a voxel along one axis of a mask; that is far below 0 beyond the mask. */
struct NearestInRow
{
  double Begin = std::numeric_limits<double>::quiet_NaN();
  std::vector<std::ptrdiff_t> Steps; ///< one, if it is the same for all voxels of the row

  void Update(double begin, double step, int count, int size, std::ptrdiff_t stride)
  {
    if (begin == this->Begin)
    {
      return; // as in the row before: grids are often parallel
    }
    this->Begin = begin;
    this->Steps.clear();
    for (int i = 0; i < (step == 0 ? 1 : count); ++i)
    {
      const int near = Nearest(begin + i * step);
      this->Steps.push_back(
        near >= 0 && near < size ? near * stride : std::numeric_limits<std::ptrdiff_t>::min() / 4);
    }
  }

  std::ptrdiff_t At(int i) const
  {
    return this->Steps.size() == 1 ? this->Steps[0] : this->Steps[static_cast<std::size_t>(i)];
  }
};

template <typename T>
void ResampleAs(const ScalarImage& mask, const ScalarImage& grid, T* to)
{
  const Affine map = MapBetween(grid, mask);
  const T* const from = static_cast<const T*>(mask.Scalars.get());
  const std::array<std::ptrdiff_t, 3> strides{ 1, mask.Dimensions[0],
    std::ptrdiff_t{ mask.Dimensions[0] } * mask.Dimensions[1] };
  std::array<NearestInRow, 3> near;
  for (int k = 0; k < grid.Dimensions[2]; ++k)
  {
    for (int j = 0; j < grid.Dimensions[1]; ++j)
    {
      const Vector3 begin = map.At(0, j, k);
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        near[axis].Update(begin[axis], map.Steps[0][axis], grid.Dimensions[0],
          mask.Dimensions[axis], strides[axis]);
      }
      for (int i = 0; i < grid.Dimensions[0]; ++i)
      {
        const std::ptrdiff_t voxel = near[0].At(i) + near[1].At(i) + near[2].At(i);
        *to++ = voxel < 0 ? T(0) : from[voxel];
      }
    }
  }
}

/** Nearest neighbours at the voxels of a grid, 0 beyond the mask. */
ScalarImage Resample(const ScalarImage& mask, const ScalarImage& grid)
{
  ScalarImage result = grid;
  result.Type = mask.Type;
  result.Scalars = AllocateVoxels(grid.NumberOfVoxels() * SizeOf(mask.Type));
  Dispatch(mask.Type,
    [&](auto zero) { ResampleAs(mask, grid, static_cast<decltype(zero)*>(result.Scalars.get())); });
  return result;
}

void CheckIsMask(const ScalarImage& image, const std::string& shown)
{
  const std::string start = shown + " is no mask, as each of several must be: it has ";
  RefuseIf(image.Frames > 1, start, image.Frames,
    " time frames, and a mask has three dimensions: give it alone");
  RefuseIf(std::count(image.Dimensions.begin(), image.Dimensions.end(), 1) > 0, start,
    "one slice, and a mask is a volume: save the slices as one volume, or give a folder of DICOM");
}

} // namespace

/** Of masks in millimetres and micrometres, one would be a thousand times too large. */
void MasksOnGrid::Check(const ScalarImage& image, const std::string& shown) const
{
  CheckIsMask(image, shown);
  const auto other = std::find_if(this->Offered.begin(), this->Offered.end(),
    [](const Place& place) { return place.Image.HasSpacing; });
  if (image.HasSpacing && other != this->Offered.end() && other->Image.Unit != image.Unit)
  {
    const auto named = [](const std::string& unit) { return unit.empty() ? "millimetres" : unit; };
    Refuse("masks must have one unit of length, but ", other->Shown, " is in ",
      named(other->Image.Unit), ", and ", shown, " in ", named(image.Unit), ": save them with one");
  }
}

/** Those that say where they lie; if none does, one whose spacing is known, or the first. */
std::vector<const MasksOnGrid::Place*> MasksOnGrid::Placed() const
{
  std::vector<const Place*> placed;
  const Place* measured = nullptr;
  for (const Place& place : this->Offered)
  {
    if (place.Image.HasPlace)
    {
      placed.push_back(&place);
    }
    measured = measured || !place.Image.HasSpacing ? measured : &place;
  }
  return !placed.empty() ? placed : std::vector{ measured ? measured : &this->Offered.front() };
}

void MasksOnGrid::OfferGrid(ScalarImage image, const std::string& shown)
{
  this->Check(image, shown);
  image.Scalars.reset();
  this->Offered.push_back({ std::move(image), shown });
  const Place& first = *this->Placed().front();
  const Place& last = this->Offered.back();
  if (last.Image.HasPlace && !this->MayResample && !AreOnOneLattice(last.Image, first.Image))
  {
    RefuseOther(first.Image, first.Shown, last.Image, last.Shown);
  }
}

bool MasksOnGrid::TakePlace(ScalarImage& image, const std::string& shown)
{
  if (image.HasPlace || this->Offered.empty())
  {
    return false;
  }
  std::vector<const Place*> same = this->Placed();
  const bool isFirstPlaced = same.front()->Image.HasPlace;
  const bool isFirstWithSpacing = !same.front()->Image.HasSpacing && image.HasSpacing;
  std::erase_if(
    same, [&image](const Place* place) { return place->Image.Dimensions != image.Dimensions; });
  if ((same.empty() && this->Offered.size() == 1) || (!isFirstPlaced && isFirstWithSpacing))
  {
    return false; // there may be others
  }
  RefuseIf(same.empty(), shown,
    " does not say where it lies, and must have the size of another mask that does, or of all, but "
    "it has ",
    Listed(image.Dimensions), " voxels: save masks with their place, as NRRD or NIfTI");
  const Place& first = *same.front();
  for (const Place* other : same)
  {
    RefuseIf(isFirstPlaced && MapBetween(other->Image, first.Image) != Affine(), shown,
      " does not say where it lies, and masks of its size lie at several places, ", first.Shown,
      " and ", other->Shown, ": save it with its place, as NRRD or NIfTI");
  }
  ScalarImage put = image;
  put.Origin = first.Image.Origin;
  put.Direction = first.Image.Direction;
  if (!image.HasSpacing)
  {
    put.Spacing = first.Image.Spacing;
    put.Unit = first.Image.Unit;
  }
  if (!AreOnOneLattice(put, first.Image))
  {
    RefuseOther(first.Image, first.Shown, put, shown);
  }
  if (!isFirstPlaced) // all lie where one of them is guessed to lie
  {
    image = std::move(put);
    return false;
  }
  this->Put += (this->Put.empty() ? "" : ", ") + shown;
  image = std::move(put);
  image.HasPlace = image.HasSpacing = true;
  return true;
}

void MasksOnGrid::CheckOneOrigin() const
{
  const Place& first = *this->Placed().front();
  for (const Place* place : this->Placed())
  {
    RefuseIf(place->Image.Origin != first.Image.Origin,
      "SetSpacing(), SetOrigin() and SetDirection() tell one place, but masks have several: ",
      first.Shown, " begins at ", Listed(first.Image.Origin), ", and ", place->Shown, " at ",
      Listed(place->Image.Origin), ": correct the files");
  }
}

const MasksOnGrid::Place& MasksOnGrid::Finest() const
{
  const std::vector<const Place*> placed = this->Placed();
  return this->MayResample ? **std::min_element(placed.begin(), placed.end(),
                               [](const Place* a, const Place* b)
                               { return VoxelVolume(a->Image) < VoxelVolume(b->Image); })
                           : *placed.front();
}

/** The finest grid, with the finest spacing along each of its axes that a mask has. */
ScalarImage MasksOnGrid::Refined() const
{
  ScalarImage grid = this->Finest().Image;
  Vector3 first{};
  Vector3 ratios{ 1, 1, 1 };
  for (const Place* place : this->Placed())
  {
    const Affine map = MapBetween(place->Image, grid);
    for (std::size_t row = 0; row < 3; ++row)
    {
      for (Vector3 step : map.Steps)
      {
        const double ratio = std::abs(step[row]);
        step[row] = 0;
        const bool isParallel = std::all_of(
          step.begin(), step.end(), [ratio](double x) { return std::abs(x) < Tolerance * ratio; });
        if (isParallel && ratio < ratios[row] * (1 - Tolerance))
        {
          ratios[row] = ratio;
          const double begin = map.First[row];
          const double low = (ratio - 1.0) / 2.0 - Tolerance * ratio; // in the first voxel
          first[row] = begin + std::ceil((low - begin) / ratio) * ratio;
        }
      }
    }
  }
  grid.Origin = PlacesOf(grid).At(first[0], first[1], first[2]);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    grid.Spacing[axis] *= ratios[axis];
  }
  return grid;
}

/** To all masks; nothing if it has too many voxels then. */
std::optional<ScalarImage> MasksOnGrid::Extended(ScalarImage grid) const
{
  Vector3 first{};
  Vector3 last{};
  double largest = 0;
  for (const Place* place : this->Placed())
  {
    const ScalarImage& image = place->Image;
    const auto [low, high] = BoxOf(image, MapBetween(image, grid), 0.5);
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      first[axis] = std::min(first[axis], std::ceil(low[axis] + Tolerance));
      last[axis] = std::max(last[axis], std::floor(high[axis] - Tolerance));
    }
    largest = std::max(largest, static_cast<double>(image.NumberOfVoxels()));
  }
  double count = 1;
  bool isInRange = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double size = last[axis] - first[axis] + 1;
    count *= size;
    isInRange = isInRange && size <= std::numeric_limits<int>::max();
  }
  if (!isInRange || count > std::max(MostVoxels, MostTimes * largest))
  {
    return std::nullopt;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    grid.Dimensions[axis] = static_cast<int>(last[axis] - first[axis]) + 1;
  }
  grid.Origin = PlacesOf(grid).At(first[0], first[1], first[2]);
  return grid;
}

ScalarImage MasksOnGrid::FindGrid() const
{
  const ScalarImage& finest = this->Finest().Image;
  std::optional<ScalarImage> grid =
    this->MayResample ? this->Extended(this->Refined()) : std::nullopt;
  return grid ? *grid : this->Extended(finest).value_or(finest);
}

bool MasksOnGrid::Add(const LabelTable::Entry& entry, ScalarImage image, const std::string& shown)
{
  this->Check(image, shown);
  if (this->Offered.empty())
  {
    this->OfferGrid(image, shown);
  }
  if (!this->Union)
  {
    this->Grid = this->FindGrid();
    this->Union.emplace(this->Grid, AllocateVoxels, "masks");
  }
  const std::string name = entry.Name.empty() ? shown : entry.Name;
  if (image.Dimensions != this->Grid.Dimensions || MapBetween(image, this->Grid) != Affine())
  {
    if (this->Offered.size() == 1)
    {
      this->OfferGrid(std::move(image), shown); // which may refuse it
      return false;
    }
    this->Resample(name, image, shown);
  }
  const std::uint32_t label = this->Union->AddName(name);
  if (!entry.Name.empty())
  {
    LabelTable own{ { { label, entry } } };
    std::vector<std::string> odd;
    LeaveOutOtherTexts(own, odd);
    for (const std::string& warning : odd)
    {
      this->OddNames.push_back(Excerpt(shown, 300) + ": " + warning);
    }
    this->Labels.Entries.merge(own.Entries);
  }
  try
  {
    this->Union->AddMask(image, this->Threshold);
  }
  catch (const InputError& error)
  {
    Refuse(shown, " is no mask, as each of several must be: ", error.what());
  }
  return true;
}

void MasksOnGrid::Resample(const std::string& name, ScalarImage& image, const std::string& shown)
{
  if (const std::uint64_t lost = CountBeyond(image, this->Grid, this->Threshold))
  {
    if (!this->MayResample)
    {
      RefuseOther(this->Grid, this->Finest().Shown, image, shown);
    }
    this->Lost += (this->Lost.empty() ? "" : ", ") + Excerpt(name) + " " + std::to_string(lost);
  }
  if (HasTies(image, this->Grid))
  {
    this->Ties += (this->Ties.empty() ? "" : ", ") + Excerpt(name);
  }
  image = voxplex::Resample(image, this->Grid);
}

ScalarImage MasksOnGrid::Finish(Overlap rule, std::vector<std::string>& warnings)
{
  if (!this->Lost.empty())
  {
    warnings.push_back("masks reach too far beyond the finest grid, that of " +
      this->Finest().Shown + ", and lose voxels there: " + this->Lost);
  }
  if (!this->Ties.empty())
  {
    warnings.push_back("faces of masks lie in the middle of voxels of the finest grid, and are up "
                       "to half a voxel off: " +
      this->Ties);
  }
  if (!this->Put.empty())
  {
    warnings.push_back("masks that do not say where they lie were put where others of their size "
                       "lie: " +
      this->Put);
  }
  const ScalarImage image = this->Union->Finish(rule, warnings);
  warnings.insert(warnings.end(), this->OddNames.begin(), this->OddNames.end());
  return image;
}

} // namespace voxplex
