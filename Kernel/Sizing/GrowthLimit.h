// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GrowthLimit.h
 * @brief Limits how fast lengths grow from cell to cell of a grid.
 */
#ifndef voxplex_GrowthLimit_h
#define voxplex_GrowthLimit_h

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <stop_token>

namespace voxplex
{

/**
 * Lowers values so that they grow by at most `steps[a]` from a cell to the next along axis a.
 * Linear in the number of cells.
 *
 * @param values of the cells; the first axis varies fastest
 * @param cells number of cells along each axis
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end
 */
template <std::size_t D>
void LimitGrowth(std::span<float> values, const std::array<std::size_t, D>& cells,
  const std::array<float, D>& steps, unsigned threads = 1, const std::stop_token& stop = {})
{
  constexpr std::size_t Strip = 4096; // cells of a layer that a thread handles at once
  std::size_t layer = 1;              // offset from a cell to the next along axis a
  for (std::size_t a = 0; a < D && !values.empty(); ++a)
  {
    const std::size_t n = cells[a];
    const std::size_t strips = (layer - 1) / Strip + 1;
    ParallelFor(
      0, values.size() / (layer * n) * strips, std::max<std::size_t>(Strip / (layer * n), 1),
      threads,
      [&](std::size_t begin, std::size_t end)
      {
        for (std::size_t s = begin; s < end; ++s)
        {
          float* const first = values.data() + s / strips * layer * n + s % strips * Strip;
          const std::size_t width = std::min(Strip, layer - s % strips * Strip);
          const float step = steps[a];
          const auto limit = [=](std::size_t k, std::size_t beside)
          {
            float* __restrict const value = first + k * layer;
            const float* __restrict const other = first + beside * layer;
            for (std::size_t c = 0; c < width; ++c)
            {
              value[c] = std::min(value[c], other[c] + step);
            }
          };
          if (layer == 1) // a row: each value needs the one before
          {
            for (std::size_t k = 1; k < n; ++k)
            {
              first[k] = std::min(first[k], first[k - 1] + step);
            }
            for (std::size_t k = n - 1; k-- > 0;)
            {
              first[k] = std::min(first[k], first[k + 1] + step);
            }
            continue;
          }
          for (std::size_t k = 1; k < n; ++k)
          {
            limit(k, k - 1);
          }
          for (std::size_t k = n - 1; k-- > 0;)
          {
            limit(k, k + 1);
          }
        }
      },
      stop);
    layer *= n;
  }
}

} // namespace voxplex

#endif
