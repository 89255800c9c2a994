// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SegmentationRepair.h
 * @brief Repairs of a label image, and what is suspicious about one. vtkSegmentationRepair.h says what each does.
 */
#ifndef voxplex_SegmentationRepair_h
#define voxplex_SegmentationRepair_h

#include "Image/LabelImage.h"
#include "Parallel/ParallelFor.h"
#include "VoxelBox.h"

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace voxplex
{

/** What was done to a label, or what is suspicious about one. */
struct RepairRow
{
  std::string What; ///< the parameter, or the kind of thing
  std::int64_t Label = 0;
  std::int64_t Voxels = 0;
  std::int64_t Places = 0;
  std::int64_t Largest = 0; ///< voxels of the place with most of them
  ///@{
  /** Its bounding box. */
  VoxelIndex First{};
  VoxelIndex Last{};
  ///@}
  std::int64_t NewLabel = 0; ///< of a shell
  bool IsAll = false;        ///< whether the shell took all of the label
  bool IsCut = false;        ///< whether a shell around the label reaches the border of the image
  std::int64_t LeftOut = 0;  ///< voxels of a shell or thickness that others keep
  std::int64_t TouchingFaces = 0; ///< between a label and what its shell should keep from it
  double ClosedFrom = 0.0;        ///< the thickness from which on voxels can hold a closed shell
};

/** Called with what is done of an operation, 0 to 1; throws Cancelled to end it. */
using RepairProgress = std::function<void(double)>;

/** @brief A whole label image that operations change one after the other. They return a row for each label. */
class SegmentationRepair
{
public:
  /**
   * An image of background.
   * @param threads 0 means all cores; no result depends on it
   */
  SegmentationRepair(const GridGeometry<3>& grid, unsigned threads, RepairProgress progress);

  /** Of the same grid. */
  void SetImage(const LabelImage<3>& image);

  /** Cavities of at most `largest` voxels. */
  std::vector<RepairRow> FillHoles(std::int64_t largest);

  std::vector<RepairRow> RemoveSpikes();

  /**
   * A smallest thickness for labels, one after the other. They take no voxel from each other.
   * @param lengths of labels, positive
   */
  std::vector<RepairRow> Thicken(const std::map<std::int64_t, double>& lengths);

  /**
   * A layer around labels, or, of a negative thickness, inside of labels, as new labels first, first + 1, ... Where
   * layers around labels meet, they share the gap in proportion to their thicknesses.
   * @throws InputError if the image has one of these
   */
  std::vector<RepairRow> MakeShells(
    const std::map<std::int64_t, double>& thicknesses, std::int64_t first);

  /** @param names of labels */
  std::vector<RepairRow> FindSuspicious(const std::map<std::int64_t, std::string>& names) const;

  /** Dense numbers of the voxels, and the label of each number. */
  const std::vector<LabelId>& Voxels() const { return this->Ids; }
  const std::vector<std::int64_t>& Labels() const { return this->Values; }

private:
  using Positions = std::vector<std::int64_t>; ///< of voxels, the first axis fastest
  struct Rows;

  /** A connected set of voxels, as runs along the first axis. */
  struct Piece
  {
    struct Run
    {
      VoxelIndex First;
      std::int64_t Length;
    };
    std::vector<Run> Runs;
    std::int64_t Voxels = 0;
    VoxelBox Box = VoxelBox::Empty();
  };

  struct Thickening
  {
    Positions Missing;
    Positions Blocked; ///< would belong to it, but have to stay
  };

  struct Shell
  {
    std::int64_t Label;
    double Thickness;
    LabelId Of; ///< 0 if the image lacks the label
    LabelId Id;
    std::int64_t InReach = 0; ///< voxels that it would have if there were no other labels
  };

  std::int64_t PositionOf(const VoxelIndex& voxel) const;
  VoxelIndex IndexOf(std::int64_t position) const;
  bool IsAtBorder(const VoxelIndex& voxel) const;
  bool IsInside(const VoxelIndex& voxel) const;
  bool Has(const VoxelIndex& voxel, LabelId id) const;
  bool IsInBlock(const VoxelIndex& voxel, LabelId id, unsigned axes) const;
  template <typename Visit>
  void ForEachNeighbour(std::int64_t position, Visit&& visit) const;
  LabelId IdOf(std::int64_t label) const;
  LabelImage<3> ImageOf(const std::vector<LabelId>& ids) const;
  VoxelBox BoxOf(LabelId id) const;
  VoxelBox BoxOf(const Positions& voxels) const;

  template <typename LabelOf>
  std::vector<Piece> FindPieces(const VoxelBox& box, const LabelOf& labelOf,
    std::int64_t largest = std::numeric_limits<std::int64_t>::max()) const;
  /** Each with the label that has most of the faces around it. */
  std::vector<std::pair<Piece, LabelId>> FindCavities(std::int64_t largest) const;
  template <typename Test>
  Positions FindVoxels(Test&& test, bool inBackground = false) const;
  std::vector<bool> MaskOf(const Positions& voxels) const;
  std::vector<Positions> PiecesOf(const Positions& voxels, LabelId ofBackground = 0) const;
  std::vector<Positions> FindSpikes() const;
  std::vector<Positions> FindNecks() const;
  std::optional<LabelId> MostFrequentAround(
    std::int64_t position, const std::vector<bool>& removed) const;
  Thickening FindThickening(LabelId id, double length, const std::vector<bool>& isBlocked) const;
  Positions LeaveComponents(Positions& taken) const;
  std::int64_t LeaveUnconnected(Positions& taken, LabelId id) const;
  RepairRow ThickenOne(std::int64_t label, double length, std::vector<bool>& isBlocked);
  template <typename Visit>
  void ForEachInReach(const Shell& shell, const Visit& visit) const;
  RepairRow DescribeShell(const Shell& shell, const std::vector<float>& distances);
  RepairRow Change(
    const std::string& what, std::int64_t label, const Positions& voxels, LabelId id);
  void AddComponents(std::vector<RepairRow>& rows) const;
  void AddContacts(std::vector<RepairRow>& rows) const;
  void AddGaps(std::vector<RepairRow>& rows) const;
  void AddVoxels(const char* what, const Positions& voxels, std::vector<RepairRow>& rows) const;

  GridGeometry<3> Grid;
  Point<3> Spacing{};
  std::vector<LabelId> Ids;
  std::vector<std::int64_t> Values;
  unsigned Threads;
  RepairProgress Progress;
};

/** One row for each label. */
struct SegmentationRepair::Rows
{
  std::string What;
  std::map<std::int64_t, RepairRow> ByLabel;

  void Add(std::int64_t label, std::int64_t voxels, const VoxelIndex& first, const VoxelIndex& last)
  {
    RepairRow& row = this->ByLabel[label];
    if (voxels > row.Largest || (voxels == row.Largest && first < row.First))
    {
      row.First = first;
      row.Last = last;
      row.Largest = voxels;
    }
    row.What = this->What;
    row.Label = label;
    row.Voxels += voxels;
    ++row.Places;
  }

  void AppendTo(std::vector<RepairRow>& rows) const
  {
    for (const auto& [label, row] : this->ByLabel)
    {
      rows.push_back(row);
    }
  }
};

/** Calls visit(position) for the voxels that share a face with one. */
template <typename Visit>
void SegmentationRepair::ForEachNeighbour(std::int64_t position, Visit&& visit) const
{
  const VoxelIndex voxel = this->IndexOf(position);
  std::int64_t stride = 1;
  for (std::size_t a = 0; a < 3; stride *= this->Grid.Dimensions[a++])
  {
    if (voxel[a] > 0)
    {
      visit(position - stride);
    }
    if (voxel[a] + 1 < this->Grid.Dimensions[a])
    {
      visit(position + stride);
    }
  }
}

/** The voxels with a label, or without, in order, for which test(index, id) is true. */
template <typename Test>
SegmentationRepair::Positions SegmentationRepair::FindVoxels(Test&& test, bool inBackground) const
{
  const VoxelIndex& n = this->Grid.Dimensions;
  std::vector<Positions> found(Unsigned(n[2]));
  ParallelFor(0, found.size(), 1, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      const VoxelBox slices{ { 0, 0, static_cast<std::int64_t>(first) },
        { n[0] - 1, n[1] - 1, static_cast<std::int64_t>(last) - 1 } };
      slices.ForEachVoxel(
        [&](const VoxelIndex& voxel)
        {
          const std::int64_t position = this->PositionOf(voxel);
          const LabelId id = this->Ids[Unsigned(position)];
          if ((id == 0) == inBackground && test(voxel, id))
          {
            found[Unsigned(voxel[2])].push_back(position);
          }
        });
    });
  Positions all;
  for (const Positions& slice : found)
  {
    all.insert(all.end(), slice.begin(), slice.end());
  }
  return all;
}

} // namespace voxplex

#endif
