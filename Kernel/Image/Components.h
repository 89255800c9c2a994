// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Components.h
 * @brief The connected components of a label image.
 */
#ifndef voxplex_Components_h
#define voxplex_Components_h

#include "Image/LabelImage.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

class DisjointSets;

/** A connected component: voxels of one label that are connected through common faces. */
template <int D>
struct Component
{
  LabelId Label = 0;
  std::int64_t Voxels = 0;
  /** Area (in 3D) of the faces between the component and other voxels or the image's border. */
  double Surface = 0.0;
  typename GridGeometry<D>::Index First{}; ///< the index of its first voxel in the crop
};

/**
 * @brief Connected components of all labels of an image, without background.
 *
 * Rows of voxels are stored as runs of one label. This needs little memory: about eight bytes per
 * run. Immutable after construction; all methods are const and thread-safe. Components are numbered
 * from 0 in the order of their first voxels. The numbers do not depend on the number of threads.
 */
template <int D>
class Components
{
public:
  using Index = typename GridGeometry<D>::Index;

  static constexpr std::uint32_t None = 0xffffffffu;

  /**
   * Time is linear in the number of voxels, memory in the number of runs.
   * @param image must live as long as this object
   * @param threads 0 means all cores; the result does not depend on it
   * @param extent voxels are neighbours along this number of axes, the first ones. D - 1: the
   *   components of each frame (in 4D) for itself. At least 2.
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  explicit Components(const LabelImage<D>& image, unsigned threads = 1,
    const std::stop_token& stop = {}, std::size_t extent = D);
  /** A temporary image is refused, since this object does not keep the image alive. */
  explicit Components(
    LabelImage<D>&&, unsigned = 1, const std::stop_token& = {}, std::size_t = D) = delete;

  /** The number of axes along which voxels are neighbours. */
  std::size_t Extent() const { return this->JoinedAxes; }

  const std::vector<Component<D>>& All() const { return this->List; }

  /**
   * The components that a mesh must not lose: those with at least `fewestVoxels` voxels, and the
   * largest component of each label, so that every label has one. If several components are the
   * largest, the first one is taken.
   * @return true or false for each component
   */
  std::vector<bool> FindWanted(std::int64_t fewestVoxels) const;

  /** The component of a voxel of the crop; None for background and outside the crop. */
  std::uint32_t At(const Index& voxel) const;

  /** Calls visit(first, length) for each run of a component along the first axis, in order. */
  template <typename Visit>
  void ForEachRun(std::uint32_t component, Visit&& visit) const
  {
    for (std::size_t r = this->FirstRun[component]; r != NoRun; r = this->NextRun[r])
    {
      visit(this->RunIndex(r), this->RunEnd(r) - this->Runs[r].Start);
    }
  }

private:
  static constexpr std::uint32_t NoRun = 0xffffffffu;
  static constexpr std::size_t RowsAtOnce = 256;

  struct Run
  {
    std::uint32_t Start;     ///< index of the first voxel along the first axis
    std::uint32_t Component; ///< None for background
  };

  std::vector<LabelId> FindRuns(
    const LabelImage<D>& image, unsigned threads, const std::stop_token& stop);
  std::vector<double> JoinRuns(const Point<D>& areas, const std::vector<LabelId>& labels,
    DisjointSets& sets, unsigned threads, const std::stop_token& stop);
  void MakeList(
    const std::vector<LabelId>& labels, const std::vector<double>& surface, DisjointSets& sets);
  std::size_t NumberOfRows() const { return this->FirstOfRow.size() - 1; }
  Index RunIndex(std::size_t run) const;
  std::uint32_t RunEnd(std::size_t run) const;

  Index Dimensions;
  std::size_t JoinedAxes;
  std::vector<std::uint32_t> FirstOfRow; ///< runs of row r: [FirstOfRow[r], FirstOfRow[r + 1])
  std::vector<Run> Runs;
  std::vector<std::uint32_t> FirstRun; ///< first run of each component
  std::vector<std::uint32_t> NextRun;  ///< for each run, the next run of its component, or NoRun
  std::vector<Component<D>> List;
};

extern template class Components<3>;
extern template class Components<4>;

} // namespace voxplex

#endif
