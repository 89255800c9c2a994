// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentationRepair.h"

#include "Base/Error.h"
#include "Image/Components.h"
#include "Image/FeatureTransform.h"
#include "Parallel/ParallelFor.h"
#include "ThinRidges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace voxplex
{

namespace
{

struct Faces
{
  std::map<LabelId, std::int64_t> Counts;

  /** Of several the smallest. */
  std::optional<LabelId> MostFrequent() const
  {
    const auto most = std::max_element(this->Counts.begin(), this->Counts.end(),
      [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == this->Counts.end() ? std::nullopt : std::optional(most->first);
  }
};

} // namespace

SegmentationRepair::SegmentationRepair(
  const GridGeometry<3>& grid, unsigned threads, RepairProgress progress)
  : Grid(grid)
  , Ids(Unsigned(grid.Dimensions[0] * grid.Dimensions[1] * grid.Dimensions[2]), 0)
  , Values{ 0 }
  , Threads(threads)
  , Progress(std::move(progress))
{
  for (std::size_t a = 0; a < 3; ++a)
  {
    this->Spacing[a] = this->Grid.Spacing(static_cast<int>(a));
  }
}

void SegmentationRepair::SetImage(const LabelImage<3>& image)
{
  this->Values.assign(image.Values().begin(), image.Values().end());
  std::fill(this->Ids.begin(), this->Ids.end(), LabelId{ 0 });
  auto from = image.Ids().begin();
  const VoxelIndex& size = image.CropDimensions();
  for (std::int64_t k = 0; k < size[2]; ++k)
  {
    for (std::int64_t j = 0; j < size[1]; ++j, from += size[0])
    {
      const VoxelIndex& origin = image.CropOrigin();
      std::copy_n(from, size[0],
        this->Ids.begin() + this->PositionOf({ origin[0], origin[1] + j, origin[2] + k }));
    }
  }
}

//------------------------------------------------------------------------------------------------
std::int64_t SegmentationRepair::PositionOf(const VoxelIndex& voxel) const
{
  const VoxelIndex& n = this->Grid.Dimensions;
  return voxel[0] + n[0] * (voxel[1] + n[1] * voxel[2]);
}

VoxelIndex SegmentationRepair::IndexOf(std::int64_t position) const
{
  const VoxelIndex& n = this->Grid.Dimensions;
  return { position % n[0], position / n[0] % n[1], position / (n[0] * n[1]) };
}

bool SegmentationRepair::IsAtBorder(const VoxelIndex& voxel) const
{
  const VoxelIndex& n = this->Grid.Dimensions;
  return std::min({ voxel[0], voxel[1], voxel[2], n[0] - 1 - voxel[0], n[1] - 1 - voxel[1],
           n[2] - 1 - voxel[2] }) == 0;
}

/** Nobody knows what is beyond the border: it has each label. */
bool SegmentationRepair::IsInside(const VoxelIndex& voxel) const
{
  bool isInside = true;
  for (std::size_t a = 0; a < 3; ++a)
  {
    isInside = isInside && voxel[a] >= 0 && voxel[a] < this->Grid.Dimensions[a];
  }
  return isInside;
}

bool SegmentationRepair::Has(const VoxelIndex& voxel, LabelId id) const
{
  return !this->IsInside(voxel) || this->Ids[Unsigned(this->PositionOf(voxel))] == id;
}

/**
 * Whether a block of the label of two voxels along some of the axes has the voxel: what opening by the block leaves.
 * @param axes bits
 */
bool SegmentationRepair::IsInBlock(const VoxelIndex& voxel, LabelId id, unsigned axes) const
{
  for (unsigned block = 0; block < 8; ++block) // on which side of the voxel it is
  {
    bool isWhole = (block & ~axes) == 0;
    for (unsigned corner = 1; corner < 8 && isWhole; ++corner)
    {
      VoxelIndex other = voxel;
      for (unsigned a = 0; a < 3; ++a)
      {
        other[a] += (corner >> a & 1u) == 0 ? 0 : (block >> a & 1u) == 0 ? 1 : -1;
      }
      isWhole = (corner & ~axes) != 0 || this->Has(other, id);
    }
    if (isWhole)
    {
      return true;
    }
  }
  return false;
}

/** 0 if the image lacks the label. */
LabelId SegmentationRepair::IdOf(std::int64_t label) const
{
  const auto found = std::find(this->Values.begin() + 1, this->Values.end(), label);
  return found == this->Values.end() ? 0 : static_cast<LabelId>(found - this->Values.begin());
}

/** Labels are the numbers. There must be one. */
LabelImage<3> SegmentationRepair::ImageOf(const std::vector<LabelId>& ids) const
{
  return LabelImage<3>::FromScalars<LabelId>(ids, this->Grid, {}, this->Threads);
}

VoxelBox SegmentationRepair::BoxOf(LabelId id) const
{
  VoxelBox box = VoxelBox::Empty();
  const VoxelIndex& n = this->Grid.Dimensions;
  for (std::int64_t row = 0; row < n[1] * n[2]; ++row)
  {
    const auto first = this->Ids.begin() + row * n[0];
    const auto found = std::find(first, first + n[0], id);
    if (found == first + n[0])
    {
      continue;
    }
    auto last = first + n[0] - 1;
    while (*last != id)
    {
      --last;
    }
    box.Include({ found - first, row % n[1], row / n[1] });
    box.Include({ last - first, row % n[1], row / n[1] });
  }
  return box;
}

VoxelBox SegmentationRepair::BoxOf(const Positions& voxels) const
{
  VoxelBox box = VoxelBox::Empty();
  for (const std::int64_t voxel : voxels)
  {
    box.Include(this->IndexOf(voxel));
  }
  return box;
}

//------------------------------------------------------------------------------------------------
/**
 * The sets of voxels of a box that are connected through faces and have one label, but for those of more than `largest` voxels.
 * @param labelOf the label at a position; 0: of no set
 */
template <typename LabelOf>
std::vector<SegmentationRepair::Piece> SegmentationRepair::FindPieces(
  const VoxelBox& box, const LabelOf& labelOf, std::int64_t largest) const
{
  GridGeometry<3> grid = this->Grid;
  grid.Dimensions = box.Size();
  using Label = decltype(labelOf(std::int64_t{}));
  std::vector<Label> labels;
  labels.reserve(Unsigned(grid.Dimensions[0] * grid.Dimensions[1] * grid.Dimensions[2]));
  box.ForEachVoxel(
    [&](const VoxelIndex& voxel) { labels.push_back(labelOf(this->PositionOf(voxel))); });
  if (std::all_of(labels.begin(), labels.end(), [](Label label) { return label == 0; }))
  {
    return {};
  }
  const auto image = LabelImage<3>::FromScalars<Label>(labels, grid, {}, this->Threads);
  const Components<3> components(image, this->Threads);
  std::vector<Piece> pieces;
  for (std::uint32_t c = 0; c < components.All().size(); ++c)
  {
    if (components.All()[c].Voxels > largest)
    {
      continue;
    }
    Piece& piece = pieces.emplace_back();
    piece.Voxels = components.All()[c].Voxels;
    components.ForEachRun(c,
      [&](const VoxelIndex& start, std::int64_t length)
      {
        const VoxelIndex first = Plus(Plus(start, image.CropOrigin()), box.First);
        piece.Runs.push_back({ first, length });
        piece.Box.Include(first);
        piece.Box.Include(Plus(first, { length - 1, 0, 0 }));
      });
  }
  return pieces;
}

std::vector<std::pair<SegmentationRepair::Piece, LabelId>> SegmentationRepair::FindCavities(
  std::int64_t largest) const
{
  std::vector<std::pair<Piece, LabelId>> cavities;
  const VoxelIndex& n = this->Grid.Dimensions;
  const VoxelBox all{ {}, Minus(n, { 1, 1, 1 }) };
  const auto isBackground = [this](std::int64_t position) -> unsigned char
  { return this->Ids[Unsigned(position)] == 0; };
  for (Piece& piece : this->FindPieces(all, isBackground, largest))
  {
    bool isEnclosed = true;
    for (std::size_t a = 0; a < 3; ++a)
    {
      isEnclosed = isEnclosed && piece.Box.First[a] > 0 && piece.Box.Last[a] + 1 < n[a];
    }
    if (!isEnclosed)
    {
      continue;
    }
    Faces faces;
    for (const Piece::Run& run : piece.Runs)
    {
      const std::int64_t first = this->PositionOf(run.First);
      for (std::int64_t voxel = first; voxel < first + run.Length; ++voxel)
      {
        this->ForEachNeighbour(voxel,
          [&](std::int64_t neighbour)
          {
            const LabelId id = this->Ids[Unsigned(neighbour)];
            faces.Counts[id] += id != 0 ? 1 : 0;
          });
      }
    }
    cavities.emplace_back(std::move(piece), *faces.MostFrequent());
  }
  return cavities;
}

std::vector<RepairRow> SegmentationRepair::FillHoles(std::int64_t largest)
{
  Rows filled{ "fill-holes", {} };
  for (const auto& [piece, id] : this->FindCavities(largest))
  {
    for (const Piece::Run& run : piece.Runs)
    {
      std::fill_n(this->Ids.begin() + this->PositionOf(run.First), run.Length, id);
    }
    filled.Add(this->Values[id], piece.Voxels, piece.Box.First, piece.Box.Last);
  }
  std::vector<RepairRow> rows;
  filled.AppendTo(rows);
  return rows;
}

//------------------------------------------------------------------------------------------------
/** Of each voxel of the image whether it is one of these. */
std::vector<bool> SegmentationRepair::MaskOf(const Positions& voxels) const
{
  std::vector<bool> isOne(this->Ids.size(), false);
  for (const std::int64_t voxel : voxels)
  {
    isOne[Unsigned(voxel)] = true;
  }
  return isOne;
}

/** The sets of these voxels that are connected through faces and have one label, their own or, in background, that given. */
std::vector<SegmentationRepair::Positions> SegmentationRepair::PiecesOf(
  const Positions& voxels, LabelId ofBackground) const
{
  if (voxels.empty())
  {
    return {};
  }
  const std::vector<bool> isOne = this->MaskOf(voxels);
  // An image has at least two voxels along each axis.
  const VoxelBox box =
    this->BoxOf(voxels).Grown(this->Spacing[0], this->Spacing, this->Grid.Dimensions);
  std::vector<Positions> pieces;
  for (const Piece& piece : this->FindPieces(box,
         [&](std::int64_t position) -> LabelId
         {
           const LabelId id = this->Ids[Unsigned(position)];
           return !isOne[Unsigned(position)] ? 0 : id == 0 ? ofBackground : id;
         }))
  {
    Positions& positions = pieces.emplace_back();
    for (const Piece::Run& run : piece.Runs)
    {
      for (std::int64_t i = 0; i < run.Length; ++i)
      {
        positions.push_back(this->PositionOf(run.First) + i);
      }
    }
  }
  return pieces;
}

/**
 * Strings of what opening takes that touch the rest of their label at one place. No voxel of a string is in a square of
 * voxels, so each face is a place. Of strings with several, the loose ends.
 */
std::vector<SegmentationRepair::Positions> SegmentationRepair::FindSpikes() const
{
  const Positions taken = this->FindVoxels(
    [this](const VoxelIndex& voxel, LabelId id)
    {
      return !this->IsInBlock(voxel, id, 0b011) && !this->IsInBlock(voxel, id, 0b101) &&
        !this->IsInBlock(voxel, id, 0b110);
    });
  const std::vector<bool> isTaken = this->MaskOf(taken);
  const auto neighboursOf = [this](std::int64_t voxel, const std::vector<bool>& without)
  {
    Positions found;
    this->ForEachNeighbour(voxel,
      [&](std::int64_t other)
      {
        if (this->Ids[Unsigned(other)] == this->Ids[Unsigned(voxel)] && !without[Unsigned(other)])
        {
          found.push_back(other);
        }
      });
    return found;
  };
  std::vector<bool> isSpike(this->Ids.size(), false);
  for (const Positions& piece : this->PiecesOf(taken))
  {
    std::size_t places = 0;
    for (const std::int64_t voxel : piece)
    {
      places += neighboursOf(voxel, isTaken).size();
    }
    for (const std::int64_t voxel : places > 0 ? piece : Positions())
    {
      isSpike[Unsigned(voxel)] = isSpike[Unsigned(voxel)] || places == 1;
      Positions next{ voxel };
      while (
        next.size() == 1 && isTaken[Unsigned(next.front())] && !isSpike[Unsigned(next.front())])
      {
        const std::int64_t end = next.front();
        next = neighboursOf(end, isSpike);
        isSpike[Unsigned(end)] = next.size() == 1;
      }
    }
  }
  Positions spikes;
  std::copy_if(taken.begin(), taken.end(), std::back_inserter(spikes),
    [&](std::int64_t voxel) { return isSpike[Unsigned(voxel)]; });
  return this->PiecesOf(spikes);
}

/** Of the faces to other labels, background among them; nothing if all of these are removed. */
std::optional<LabelId> SegmentationRepair::MostFrequentAround(
  std::int64_t position, const std::vector<bool>& removed) const
{
  Faces faces;
  this->ForEachNeighbour(position,
    [&](std::int64_t neighbour)
    {
      const LabelId id = this->Ids[Unsigned(neighbour)];
      if (!removed[Unsigned(neighbour)] && id != this->Ids[Unsigned(position)])
      {
        ++faces.Counts[id];
      }
    });
  return faces.MostFrequent();
}

std::vector<RepairRow> SegmentationRepair::RemoveSpikes()
{
  Rows removed{ "remove-spikes", {} };
  Positions waiting;
  for (const Positions& spike : this->FindSpikes())
  {
    const VoxelBox box = this->BoxOf(spike);
    removed.Add(
      this->Values[this->Ids[Unsigned(spike.front())]], std::ssize(spike), box.First, box.Last);
    waiting.insert(waiting.end(), spike.begin(), spike.end());
  }
  std::vector<bool> isWaiting = this->MaskOf(waiting);
  // From outside to inside, where spikes of several labels touch.
  while (!waiting.empty())
  {
    std::vector<std::pair<std::int64_t, LabelId>> changes;
    Positions later;
    for (const std::int64_t voxel : waiting)
    {
      if (const auto id = this->MostFrequentAround(voxel, isWaiting))
      {
        changes.emplace_back(voxel, *id);
      }
      else
      {
        later.push_back(voxel);
      }
    }
    for (const std::int64_t voxel : changes.empty() ? later : Positions())
    {
      changes.emplace_back(voxel, LabelId{ 0 });
    }
    waiting = changes.size() == waiting.size() ? Positions() : later;
    for (const auto& [voxel, id] : changes)
    {
      this->Ids[Unsigned(voxel)] = id;
      isWaiting[Unsigned(voxel)] = false;
    }
  }
  std::vector<RepairRow> rows;
  removed.AppendTo(rows);
  return rows;
}

//------------------------------------------------------------------------------------------------
/** What a label lacks. @param isBlocked of each voxel: has to stay as it is */
SegmentationRepair::Thickening SegmentationRepair::FindThickening(
  LabelId id, double length, const std::vector<bool>& isBlocked) const
{
  Thickening found;
  const VoxelIndex& n = this->Grid.Dimensions;
  const double margin =
    2.75 * length + 2.0 * *std::max_element(this->Spacing.begin(), this->Spacing.end());
  const Point<3> half{ this->Spacing[0] / 2.0, this->Spacing[1] / 2.0, this->Spacing[2] / 2.0 };
  this->BoxOf(id)
    .Grown(1.25 * length, this->Spacing, n)
    .ForEachBlock(margin, this->Spacing,
      [&](const VoxelBox& block)
      {
        this->Progress(static_cast<double>(block.First[2]) / static_cast<double>(n[2]));
        const VoxelBox around = block.Grown(margin, this->Spacing, n);
        const VoxelIndex size = around.Size();
        const HalfVoxels halves{ { 2 * size[0], 2 * size[1], 2 * size[2] }, half, this->Threads };
        BitMask<3> outside(halves.Size);
        BitMask<3> blocked(halves.Size);
        std::int64_t voxels = 0;
        bool isAnyBlocked = false;
        around.ForEachVoxel(
          [&](const VoxelIndex& voxel)
          {
            const std::int64_t position = this->PositionOf(voxel);
            const bool isLabel = this->Ids[Unsigned(position)] == id;
            const bool isOne = !isLabel && isBlocked[Unsigned(position)];
            voxels += isLabel ? 1 : 0;
            isAnyBlocked = isAnyBlocked || isOne;
            HalfVoxels::ForEachOf(Minus(voxel, around.First),
              [&](const VoxelIndex& at)
              {
                isLabel ? void() : outside.Set(at);
                isOne ? blocked.Set(at) : void();
              });
          });
        if (voxels == 0 || voxels == size[0] * size[1] * size[2])
        {
          return;
        }
        const VoxelIndex first = Minus(block.First, around.First);
        const VoxelIndex last = Minus(block.Last, around.First);
        const auto balls = halves.Thickened(outside, isAnyBlocked ? &blocked : nullptr,
          length / 2.0, { Plus(first, first), Plus(Plus(last, last), { 1, 1, 1 }) });
        if (!balls)
        {
          return;
        }
        block.ForEachVoxel(
          [&](const VoxelIndex& voxel)
          {
            const std::int64_t position = this->PositionOf(voxel);
            int inside = 0;
            HalfVoxels::ForEachOf(Minus(voxel, around.First),
              [&](const VoxelIndex& at) { inside += balls->Test(at) ? 1 : 0; });
            if (inside >= 4 && this->Ids[Unsigned(position)] != id)
            {
              (isBlocked[Unsigned(position)] ? found.Blocked : found.Missing).push_back(position);
            }
          });
      });
  std::sort(found.Missing.begin(), found.Missing.end());
  return found;
}

/** Leaves out the voxels of components that would lose all of theirs, and returns these. */
SegmentationRepair::Positions SegmentationRepair::LeaveComponents(Positions& taken) const
{
  if (std::all_of(taken.begin(), taken.end(),
        [this](std::int64_t voxel) { return this->Ids[Unsigned(voxel)] == 0; }))
  {
    return {};
  }
  const LabelImage<3> image = this->ImageOf(this->Ids);
  const Components<3> components(image, this->Threads);
  const auto componentOf = [&](std::int64_t voxel)
  { return components.At(Minus(this->IndexOf(voxel), image.CropOrigin())); };
  std::map<std::uint32_t, std::int64_t> losses;
  for (const std::int64_t voxel : taken)
  {
    ++losses[componentOf(voxel)];
  }
  const auto kept = std::stable_partition(taken.begin(), taken.end(),
    [&](std::int64_t voxel)
    {
      const std::uint32_t component = componentOf(voxel);
      return component == Components<3>::None ||
        losses[component] < components.All()[component].Voxels;
    });
  const Positions left(kept, taken.end());
  taken.erase(kept, taken.end());
  return left;
}

/**
 * Leaves out the voxels, which are sorted, that no faces connect to the label: they are beyond something else.
 * @return their number
 */
std::int64_t SegmentationRepair::LeaveUnconnected(Positions& taken, LabelId id) const
{
  std::vector<char> isConnected(taken.size(), 0);
  std::vector<std::size_t> next;
  const auto connect = [&](std::size_t at)
  {
    if (isConnected[at] == 0)
    {
      isConnected[at] = 1;
      next.push_back(at);
    }
  };
  for (std::size_t at = 0; at < taken.size(); ++at)
  {
    this->ForEachNeighbour(taken[at],
      [&](std::int64_t neighbour)
      {
        if (this->Ids[Unsigned(neighbour)] == id)
        {
          connect(at);
        }
      });
  }
  while (!next.empty())
  {
    const std::int64_t voxel = taken[next.back()];
    next.pop_back();
    this->ForEachNeighbour(voxel,
      [&](std::int64_t neighbour)
      {
        const auto found = std::lower_bound(taken.begin(), taken.end(), neighbour);
        if (found != taken.end() && *found == neighbour)
        {
          connect(Unsigned(found - taken.begin()));
        }
      });
  }
  std::size_t at = 0;
  return static_cast<std::int64_t>(
    std::erase_if(taken, [&](std::int64_t) { return isConnected[at++] == 0; }));
}

/** Gives voxels another number, and says where they are. */
RepairRow SegmentationRepair::Change(
  const std::string& what, std::int64_t label, const Positions& voxels, LabelId id)
{
  if (voxels.empty())
  {
    return { .What = what, .Label = label };
  }
  for (const std::int64_t voxel : voxels)
  {
    this->Ids[Unsigned(voxel)] = id;
  }
  Rows rows{ what, {} };
  for (const Positions& piece : this->PiecesOf(voxels, 1)) // they may be background now
  {
    const VoxelBox box = this->BoxOf(piece);
    rows.Add(label, std::ssize(piece), box.First, box.Last);
  }
  return rows.ByLabel.at(label);
}

/** Gives a label its thickness. @param isBlocked see FindThickening(); gets components that would be lost */
RepairRow SegmentationRepair::ThickenOne(
  std::int64_t label, double length, std::vector<bool>& isBlocked)
{
  const LabelId id = this->IdOf(label);
  if (id == 0)
  {
    return { .What = "min-thickness", .Label = label };
  }
  const auto leave = [&](Positions& missing)
  {
    const Positions components = this->LeaveComponents(missing);
    for (const std::int64_t voxel : components)
    {
      isBlocked[Unsigned(voxel)] = true;
    }
    return !components.empty();
  };
  Thickening found = this->FindThickening(id, length, isBlocked);
  bool isToMeasure = !found.Blocked.empty();
  for (int tries = 0; leave(found.Missing) && tries < 2; ++tries)
  {
    isToMeasure = true;
    found = this->FindThickening(id, length, isBlocked);
  }
  isToMeasure = this->LeaveUnconnected(found.Missing, id) > 0 || isToMeasure;
  RepairRow row = this->Change("min-thickness", label, found.Missing, id);
  if (isToMeasure)
  {
    found = this->FindThickening(id, length, isBlocked);
    row.LeftOut = std::ssize(found.Blocked) + this->LeaveUnconnected(found.Missing, id);
  }
  return row;
}

std::vector<RepairRow> SegmentationRepair::Thicken(const std::map<std::int64_t, double>& lengths)
{
  std::vector<bool> isKept(this->Values.size(), false);
  for (const auto& [label, length] : lengths)
  {
    isKept[this->IdOf(label)] = true;
  }
  isKept[0] = false; // of labels that the image lacks
  std::vector<RepairRow> rows;
  for (const auto& [label, length] : lengths)
  {
    std::vector<bool> isBlocked(this->Ids.size());
    std::transform(this->Ids.begin(), this->Ids.end(), isBlocked.begin(),
      [&isKept](LabelId id) -> bool { return isKept[id]; });
    rows.push_back(this->ThickenOne(label, length, isBlocked));
  }
  return rows;
}

//------------------------------------------------------------------------------------------------
/**
 * Calls visit(position, distance) for the voxels around a label that are in reach of a shell, or, if its thickness is
 * negative, for those of the label. Distances are parts of the reach. Voxels that visit() makes part of the shell change
 * nothing for others.
 */
template <typename Visit>
void SegmentationRepair::ForEachInReach(const Shell& shell, const Visit& visit) const
{
  if (shell.Of == 0)
  {
    return;
  }
  const VoxelIndex& n = this->Grid.Dimensions;
  double diameter = 0.0; // of the image, or more
  for (std::size_t a = 0; a < 3; ++a)
  {
    diameter += static_cast<double>(n[a]) * this->Spacing[a];
  }
  // The half axes of an ellipsoid: half a voxel and the thickness.
  Point<3> reach;
  Point<3> parts;
  for (std::size_t a = 0; a < 3; ++a)
  {
    reach[a] = this->Spacing[a] / 2.0 + std::min(std::abs(shell.Thickness), diameter);
    parts[a] = this->Spacing[a] / reach[a];
  }
  const double margin = *std::max_element(reach.begin(), reach.end());
  const auto isSite = [&](const VoxelIndex& voxel)
  {
    const LabelId own = this->Ids[Unsigned(this->PositionOf(voxel))];
    return shell.Thickness > 0.0 ? own == shell.Of : own != shell.Of && own != shell.Id;
  };
  // Also at edges and corners, or the mesh has holes there.
  const auto isBesideSite = [&](const VoxelIndex& voxel)
  {
    return IsAnyAround(voxel,
      [&](const VoxelIndex& other)
      {
        bool isOne = this->IsInside(other) && isSite(other);
        for (std::size_t a = 0; a < 3; ++a)
        {
          isOne = isOne && (other[a] == voxel[a] || parts[a] <= 1.0 + DistanceRounding);
        }
        return isOne;
      });
  };
  const VoxelBox box = this->BoxOf(shell.Of);
  const VoxelBox region = shell.Thickness > 0.0 ? box.Grown(margin, this->Spacing, n) : box;
  region.ForEachBlock(margin, this->Spacing,
    [&](const VoxelBox& block)
    {
      this->Progress(static_cast<double>(block.First[2]) / static_cast<double>(n[2]));
      const VoxelBox around = block.Grown(margin, this->Spacing, n);
      const VoxelIndex size = around.Size();
      BitMask<3> sites(size);
      around.ForEachVoxel(
        [&](const VoxelIndex& voxel)
        {
          if (isSite(voxel))
          {
            sites.Set(Minus(voxel, around.First));
          }
        });
      const FeatureTransform<3> nearest(sites, parts, { 1, 1, 1 }, this->Threads);
      block.ForEachVoxel(
        [&](const VoxelIndex& voxel)
        {
          const VoxelIndex at = Minus(voxel, around.First);
          const float distance =
            nearest.Distance(Unsigned(at[0] + size[0] * (at[1] + size[1] * at[2])));
          const bool isInReach = distance <= 1.0 + DistanceRounding;
          if (distance > 0.0F && (isInReach || (distance < 2.0 && isBesideSite(voxel))))
          {
            visit(this->PositionOf(voxel), distance);
          }
        });
    });
}

/** What became of a shell. @param distances see MakeShells() */
RepairRow SegmentationRepair::DescribeShell(const Shell& shell, const std::vector<float>& distances)
{
  const Positions layer =
    this->FindVoxels([&shell](const VoxelIndex&, LabelId own) { return own == shell.Id; });
  RepairRow row = this->Change("shell", shell.Label, layer, shell.Id);
  row.NewLabel = this->Values[shell.Id];
  row.IsAll = shell.Of != 0 && this->BoxOf(shell.Of).Last[0] < 0;
  row.IsCut = shell.Thickness > 0.0 &&
    std::any_of(layer.begin(), layer.end(),
      [this](std::int64_t voxel) { return this->IsAtBorder(this->IndexOf(voxel)); });
  row.LeftOut = shell.InReach - std::ssize(layer);
  row.ClosedFrom = *std::max_element(this->Spacing.begin(), this->Spacing.end()) / 2.0;
  if (shell.Of == 0)
  {
    return row;
  }
  const auto isKeptAway = [&](std::size_t position)
  {
    const LabelId own = this->Ids[position];
    return own != shell.Id && own != shell.Of &&
      (shell.Thickness < 0.0 || own == 0 || distances[position] > 0.0F);
  };
  this->BoxOf(shell.Of).ForEachVoxel(
    [&](const VoxelIndex& voxel)
    {
      const std::int64_t position = this->PositionOf(voxel);
      if (this->Ids[Unsigned(position)] == shell.Of)
      {
        this->ForEachNeighbour(position,
          [&](std::int64_t other) { row.TouchingFaces += isKeptAway(Unsigned(other)) ? 1 : 0; });
      }
    });
  return row;
}

std::vector<RepairRow> SegmentationRepair::MakeShells(
  const std::map<std::int64_t, double>& thicknesses, std::int64_t first)
{
  std::vector<Shell> shells;
  for (const auto& [label, thickness] : thicknesses)
  {
    const std::int64_t added = first + std::ssize(shells);
    if (this->IdOf(added) != 0)
    {
      throw InputError("{shell}: the new label " + std::to_string(added) + " is in the image.");
    }
    const auto id = static_cast<LabelId>(this->Values.size() + shells.size());
    shells.push_back({ label, thickness, this->IdOf(label), id });
  }
  // Of voxels in shells around labels: these share a gap in proportion to their thicknesses.
  std::vector<float> distances(shells.empty() ? 0 : this->Ids.size(), 0.0F);
  for (Shell& shell : shells)
  {
    this->Values.push_back(first++);
    this->ForEachInReach(shell,
      [&](std::int64_t position, float distance)
      {
        ++shell.InReach;
        LabelId& own = this->Ids[Unsigned(position)];
        float& nearest = distances[Unsigned(position)];
        if (shell.Thickness < 0.0)
        {
          own = shell.Id;
        }
        else if (own == 0 || distance < nearest * (1.0 - DistanceRounding))
        {
          own = shell.Id;
          nearest = distance;
        }
      });
  }
  std::vector<RepairRow> rows;
  for (const Shell& shell : shells)
  {
    rows.push_back(this->DescribeShell(shell, distances));
  }
  return rows;
}

} // namespace voxplex
