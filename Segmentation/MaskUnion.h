// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MaskUnion.h
 * @brief Several masks, which may overlap, become one label image.
 */
#ifndef voxplex_MaskUnion_h
#define voxplex_MaskUnion_h

#include "ScalarImage.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace voxplex
{

/** Which of the masks that have a voxel gets it; with the numbers of VTK's classes, OVERLAP_SMALLEST and OVERLAP_ORDER. */
enum class Overlap
{
  Smallest, ///< the one with the fewest voxels, of equals the first
  Order     ///< the first
};

/** Whole numbers are inside unless 0, real ones, which are probabilities, above a threshold. */
template <typename T>
constexpr bool IsInside(T voxel, double threshold = 0.5)
{
  return std::is_floating_point_v<T> ? voxel > static_cast<T>(threshold) : voxel != T(0);
}

/**
 * Takes masks one after the other, of which none is kept: it has two bytes a voxel for the set of masks that have it.
 * Different sets are few, and are listed apart, so that all sizes and overlaps are exact.
 */
class MaskUnion
{
public:
  /**
   * @param grid where all masks lie; its voxels are not used
   * @param word what messages call masks
   */
  MaskUnion(const ScalarImage& grid, const VoxelAllocator& allocate, std::string word);

  /**
   * Of the next mask, which need not have voxels.
   *
   * @param label 0: its number
   * @return its number, from 1 on
   */
  std::uint32_t AddName(std::string name, std::uint16_t label = 0);

  /**
   * Adds the last named mask.
   *
   * @param threshold above which probabilities are inside
   * @throws InputError with the reason alone: real numbers that are no probabilities, more than 65535 sets of masks
   */
  void AddMask(const ScalarImage& mask, double threshold = 0.5);

  /** Adds voxels of one slice to a mask: those that are not 0. Masks are to be added in one order in all slices. */
  void AddSlice(const std::vector<std::uint8_t>& voxels, std::size_t slice, std::uint32_t number);

  /** Adds those masks whose numbers the values of a frame stand for. Other values are outside. */
  void AddLayer(const ScalarImage& image, int frame,
    const std::unordered_map<std::int64_t, std::uint32_t>& numbers);

  /** Makes labels of the sets. @param warnings receives what overlaps, and what has no voxels, a line each */
  ScalarImage Finish(Overlap rule, std::vector<std::string>& warnings);

private:
  using Set = std::uint16_t;
  using Counts = std::vector<std::uint64_t>;

  std::span<Set> AllSets() const;
  template <typename T, typename TNumberOf>
  void Add(std::span<Set> to, const T* voxels, TNumberOf&& numberOf);
  Set With(Set set, std::uint32_t number);
  void WarnOfOverlaps(Overlap rule, const Counts& voxels, std::vector<std::string>& warnings) const;
  void WarnOf(const std::string& what, const std::vector<std::uint32_t>& numbers,
    std::vector<std::string>& warnings) const;
  const std::string& NameOf(std::uint32_t number) const { return this->Names[number - 1]; }

  ScalarImage Image; ///< of sets
  std::string Word;
  std::vector<std::string> Names;
  std::vector<Set> Labels; ///< of each number, from 1 on
  std::vector<std::uint32_t> WithSeveralValues;
  std::vector<std::vector<std::uint32_t>> Members{ {} }; ///< of each set; the first is background
  std::map<std::pair<Set, std::uint32_t>, Set> Successors;
};

} // namespace voxplex

#endif
