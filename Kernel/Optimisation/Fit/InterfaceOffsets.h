// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceOffsets.h
 * @brief Distances by which whole interfaces are moved, so that labels have their volumes.
 */
#ifndef voxplex_InterfaceOffsets_h
#define voxplex_InterfaceOffsets_h

#include "Image/LabelImage.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace voxplex
{

/**
 * @brief An offset for each pair of labels that have an interface; positive makes the inner label
 * larger.
 *
 * An interface belongs to two labels, so one offset changes two volumes; background may have any.
 * Let A be the area of an interface and M(l) the volume that label l is missing. What is wanted is
 * sum A o = M(l) over the interfaces of each label l, with the sign of the side that l is on. Sweeps
 * over the interfaces solve this well enough: each gives its two labels what both ask for on average,
 * per area of all their interfaces.
 */
class InterfaceOffsets
{
public:
  /**
   * Adds a facet. Returns the number of its interface.
   * @param area its weight; 0 if it cannot be moved
   * @param edge its shortest edge
   */
  std::uint32_t Add(LabelId inner, LabelId outer, double area, double edge)
  {
    if (this->All.empty() || this->All[this->Last].Inner != inner ||
      this->All[this->Last].Outer != outer)
    {
      const auto key = (std::uint64_t{ inner } << 32) | outer;
      this->Last = this->Numbers.try_emplace(key, this->All.size()).first->second;
      if (this->Last == this->All.size())
      {
        this->All.push_back({ inner, outer, 0.0, 0.0, 0.0 });
        this->AreaOf.resize(std::max<std::size_t>(this->AreaOf.size(), std::size_t{ inner } + 1));
      }
    }
    Interface& interface = this->All[this->Last];
    interface.Area += area;
    interface.EdgeTimesArea += edge * area;
    this->AreaOf[inner] += area;
    this->AreaOf[outer] += area;
    return static_cast<std::uint32_t>(this->Last);
  }

  /** One more than the largest label. */
  std::size_t NumberOfLabels() const { return this->AreaOf.size(); }

  double operator[](std::uint32_t interface) const { return this->All[interface].Offset; }

  /** Changes offsets so that labels gain what they are missing. */
  void Share(std::vector<double> missing)
  {
    for (unsigned sweep = 0; sweep < Sweeps; ++sweep)
    {
      for (Interface& interface : this->All)
      {
        if (!(interface.Area > 0.0))
        {
          continue;
        }
        const double inner = missing[interface.Inner] / this->AreaOf[interface.Inner];
        const double step = interface.Outer == 0
          ? inner
          : 0.5 * (inner - missing[interface.Outer] / this->AreaOf[interface.Outer]);
        const double most = Largest * interface.EdgeTimesArea / interface.Area;
        const double offset = std::clamp(interface.Offset + step, -most, most);
        const double gain = interface.Area * (offset - interface.Offset);
        missing[interface.Inner] -= gain;
        missing[interface.Outer] += gain;
        interface.Offset = offset;
      }
    }
  }

private:
  static constexpr unsigned Sweeps = 50;

  /** The largest offset, in mean shortest edges of the facets. */
  static constexpr double Largest = 0.1;

  /** All facets between two labels. The outer one is the smaller one. */
  struct Interface
  {
    LabelId Inner;
    LabelId Outer;
    double Area;
    double EdgeTimesArea;
    double Offset;
  };

  std::vector<Interface> All;
  std::unordered_map<std::uint64_t, std::size_t> Numbers; ///< by both labels
  std::vector<double> AreaOf;                             ///< of all interfaces of each label
  std::size_t Last = 0;                                   ///< the interface of the last facet
};

} // namespace voxplex

#endif
