// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What is suspicious about a label image: the part of SegmentationRepair that changes nothing.
#include "Image/Components.h"
#include "SegmentationRepair.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>

namespace voxplex
{

namespace
{

/** Components with fewer voxels are crumbs: those that a mesh may lose by default. */
constexpr std::int64_t CrumbVoxels = 8;

} // namespace

/** All but the largest component of each label. */
void SegmentationRepair::AddComponents(std::vector<RepairRow>& rows) const
{
  if (std::all_of(this->Ids.begin(), this->Ids.end(), [](LabelId id) { return id == 0; }))
  {
    return;
  }
  const LabelImage<3> image = this->ImageOf(this->Ids);
  const Components<3> components(image, this->Threads);
  const std::vector<bool> isLargest =
    components.FindWanted(std::numeric_limits<std::int64_t>::max());
  Rows others{ "components", {} };
  Rows crumbs{ "crumbs", {} };
  for (std::size_t c = 0; c < isLargest.size(); ++c)
  {
    const Component<3>& component = components.All()[c];
    if (!isLargest[c])
    {
      const VoxelIndex first = Plus(component.First, image.CropOrigin());
      const std::int64_t label = this->Values[Unsigned(image.Values()[component.Label])];
      (component.Voxels < CrumbVoxels ? crumbs : others).Add(label, component.Voxels, first, first);
    }
  }
  others.AppendTo(rows);
  crumbs.AppendTo(rows);
}

/** Edges and corners at which voxels of a label meet without a voxel of the label beside both. */
void SegmentationRepair::AddContacts(std::vector<RepairRow>& rows) const
{
  const auto countAt = [this](const VoxelIndex& voxel, LabelId id)
  {
    bool isInside = true; // then there is one beside each
    this->ForEachNeighbour(this->PositionOf(voxel),
      [&](std::int64_t neighbour) { isInside = isInside && this->Ids[Unsigned(neighbour)] == id; });
    int count = 0;
    for (int step = 1; step < 27 && !isInside;
         ++step) // to each diagonal neighbour that comes later
    {
      const VoxelIndex move{ step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1 };
      const VoxelIndex other = Plus(voxel, move);
      const bool isLater = move[2] > 0 || (move[2] == 0 && (move[1] > 0));
      const std::int64_t axes = std::abs(move[0]) + std::abs(move[1]) + std::abs(move[2]);
      if (!isLater || axes < 2 || !this->Has(other, id) || this->Has(other, 0))
      {
        continue;
      }
      bool isBeside = false;
      for (unsigned part = 1; part < 7; ++part) // some of the moves, not all
      {
        const VoxelIndex between{ voxel[0] + ((part & 1u) ? move[0] : 0),
          voxel[1] + ((part & 2u) ? move[1] : 0), voxel[2] + ((part & 4u) ? move[2] : 0) };
        isBeside = isBeside || (between != voxel && between != other && this->Has(between, id));
      }
      count += isBeside ? 0 : 1;
    }
    return count;
  };
  this->AddVoxels("contacts",
    this->FindVoxels([&](const VoxelIndex& voxel, LabelId id) { return countAt(voxel, id) > 0; }),
    rows);
}

/** Necks: bridges of what opening by three voxels takes. */
std::vector<SegmentationRepair::Positions> SegmentationRepair::FindNecks() const
{
  const std::vector<bool> isMiddle = this->MaskOf( // of a block of three voxels
    this->FindVoxels(
      [&](const VoxelIndex& voxel, LabelId id) {
        return !IsAnyAround(voxel, [&](const VoxelIndex& other) { return !this->Has(other, id); });
      }));
  std::vector<LabelId> rest = this->Ids;
  const Positions taken = this->FindVoxels(
    [&](const VoxelIndex& voxel, LabelId id)
    {
      return !IsAnyAround(voxel,
        [&](const VoxelIndex& other)
        {
          return this->IsInside(other) && isMiddle[Unsigned(this->PositionOf(other))] &&
            this->Has(other, id);
        });
    });
  for (const std::int64_t voxel : taken)
  {
    rest[Unsigned(voxel)] = 0;
  }
  if (taken.empty() || std::all_of(rest.begin(), rest.end(), [](LabelId id) { return id == 0; }))
  {
    return {};
  }
  const LabelImage<3> image = this->ImageOf(rest);
  const Components<3> parts(image, this->Threads);
  std::vector<Positions> necks = this->PiecesOf(taken);
  std::erase_if(necks,
    [&](const Positions& piece)
    {
      std::set<std::uint32_t> beside;
      for (const std::int64_t voxel : piece)
      {
        this->ForEachNeighbour(voxel,
          [&](std::int64_t other)
          {
            if (rest[Unsigned(other)] == this->Ids[Unsigned(voxel)])
            {
              beside.insert(parts.At(Minus(this->IndexOf(other), image.CropOrigin())));
            }
          });
      }
      return beside.size() < 2;
    });
  return necks;
}

/** Background thinner than two voxels, at each label beside it, unless it is a cavity. */
void SegmentationRepair::AddGaps(std::vector<RepairRow>& rows) const
{
  const Positions thin = this->FindVoxels(
    [this](const VoxelIndex& voxel, LabelId) { return !this->IsInBlock(voxel, 0, 0b111); }, true);
  const std::vector<bool> isThin = this->MaskOf(thin);
  std::map<LabelId, Positions> beside;
  for (const std::int64_t position : thin)
  {
    std::set<LabelId> labels;
    this->ForEachNeighbour(
      position, [&](std::int64_t neighbour) { labels.insert(this->Ids[Unsigned(neighbour)]); });
    labels.erase(0);
    for (const LabelId id : labels)
    {
      beside[id].push_back(position);
    }
  }
  const auto isOpen = [&](std::int64_t position)
  {
    bool ends = this->IsAtBorder(this->IndexOf(position));
    this->ForEachNeighbour(position,
      [&](std::int64_t neighbour)
      { ends = ends || (this->Ids[Unsigned(neighbour)] == 0 && !isThin[Unsigned(neighbour)]); });
    return ends;
  };
  Rows gaps{ "gaps", {} };
  for (const auto& [id, positions] : beside)
  {
    for (const Positions& piece : this->PiecesOf(positions, id))
    {
      if (std::any_of(piece.begin(), piece.end(), isOpen))
      {
        const VoxelBox box = this->BoxOf(piece);
        gaps.Add(this->Values[id], std::ssize(piece), box.First, box.Last);
      }
    }
  }
  gaps.AppendTo(rows);
}

/** Each voxel is a place of its label. */
void SegmentationRepair::AddVoxels(
  const char* what, const Positions& voxels, std::vector<RepairRow>& rows) const
{
  Rows found{ what, {} };
  for (const std::int64_t position : voxels)
  {
    const VoxelIndex voxel = this->IndexOf(position);
    found.Add(this->Values[this->Ids[Unsigned(position)]], 1, voxel, voxel);
  }
  found.AppendTo(rows);
}

std::vector<RepairRow> SegmentationRepair::FindSuspicious(
  const std::map<std::int64_t, std::string>& names) const
{
  std::vector<RepairRow> rows;
  this->AddComponents(rows);
  Rows cavities{ "cavities", {} };
  for (const auto& [piece, id] : this->FindCavities(std::numeric_limits<std::int64_t>::max()))
  {
    cavities.Add(this->Values[id], piece.Voxels, piece.Box.First, piece.Box.Last);
  }
  cavities.AppendTo(rows);
  const auto addPieces = [&](const char* what, const std::vector<Positions>& pieces)
  {
    Rows found{ what, {} };
    for (const Positions& piece : pieces)
    {
      const VoxelBox box = this->BoxOf(piece);
      found.Add(
        this->Values[this->Ids[Unsigned(piece.front())]], std::ssize(piece), box.First, box.Last);
    }
    found.AppendTo(rows);
  };
  addPieces("spikes", this->FindSpikes());
  addPieces("thin",
    this->PiecesOf(this->FindVoxels(
      [this](const VoxelIndex& voxel, LabelId id) { return !this->IsInBlock(voxel, id, 0b111); })));
  addPieces("necks", this->FindNecks());
  this->AddGaps(rows);
  this->AddContacts(rows);
  this->AddVoxels("border",
    this->FindVoxels([this](const VoxelIndex& voxel, LabelId) { return this->IsAtBorder(voxel); }),
    rows);
  std::vector<bool> occurs(this->Values.size(), false);
  std::for_each(this->Ids.begin(), this->Ids.end(), [&](LabelId id) { occurs[id] = true; });
  for (const auto& [label, name] : names)
  {
    if (this->IdOf(label) == 0 || !occurs[this->IdOf(label)])
    {
      rows.push_back({ .What = "absent", .Label = label });
    }
  }
  for (std::size_t id = 0; id < occurs.size(); ++id)
  {
    occurs[id] = !names.empty() && names.count(this->Values[id]) == 0; // has no name
  }
  this->AddVoxels("unnamed",
    this->FindVoxels([&occurs](const VoxelIndex&, LabelId id) { return occurs[id]; }), rows);
  return rows;
}

} // namespace voxplex
