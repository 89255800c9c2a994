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

/** A set of voxels of one label that are connected through common faces. */
template <int D>
struct Component
{
  LabelId Label = 0;
  std::int64_t Voxels = 0;
  double Surface =
    0.0; ///< area (3D) of the faces between the set and the rest, of the image's end, too
  typename GridGeometry<D>::Index First{}; ///< one of its voxels, an index of the crop
};

/**
 * @brief Connected components of all labels of an image, background left out.
 *
 * Rows of voxels are kept as runs of one label, so that it takes little memory: about eight bytes a
 * run. Immutable after construction; all methods are const and safe to call from any thread. Ids of
 * components run from 0 in the order of their first voxels, whatever the number of threads.
 */
template <int D>
class Components
{
public:
  using Index = typename GridGeometry<D>::Index;

  static constexpr std::uint32_t None = 0xffffffffu;

  /**
   * Time and memory: linear in the number of voxels and of runs.
   * @param image must live as long as this
   * @param threads 0 means all cores; the result does not depend on it
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  explicit Components(
    const LabelImage<D>& image, unsigned threads = 1, const std::stop_token& stop = {});
  /** The components do not keep the image alive. */
  explicit Components(LabelImage<D>&&, unsigned = 1, const std::stop_token& = {}) = delete;

  const std::vector<Component<D>>& All() const { return this->List; }

  /**
   * Those that a mesh must not lose: of at least so many voxels, or the largest of their label, the first of several,
   * so that no label is left without one.
   * @return by component
   */
  std::vector<bool> FindWanted(std::int64_t fewestVoxels) const;

  /** The component of a voxel of the crop; None for background and beyond the crop. */
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

  struct Run
  {
    std::uint32_t Start;     ///< along the first axis
    std::uint32_t Component; ///< None for background
  };

  /** Rows are numbered with the second axis fastest. */
  std::size_t RowOf(const Index& voxel) const;
  Index RunIndex(std::size_t run) const;
  std::uint32_t RunEnd(std::size_t run) const;

  Index Dimensions;
  std::vector<std::uint32_t> FirstOfRow; ///< runs of row r: [FirstOfRow[r], FirstOfRow[r + 1])
  std::vector<Run> Runs;
  std::vector<std::uint32_t> FirstRun; ///< by component
  std::vector<std::uint32_t> NextRun;  ///< by run, the next of its component
  std::vector<Component<D>> List;
};

extern template class Components<3>;
extern template class Components<4>;

} // namespace voxplex

#endif
