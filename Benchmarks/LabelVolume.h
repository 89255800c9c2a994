// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelVolume.h
 * @brief The label image that a comparison passes to every mesher.
 */
#ifndef voxplex_LabelVolume_h
#define voxplex_LabelVolume_h

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace voxplex::benchmarks
{

/**
 * Labels with their spacing. Origin and direction are left out, as they only move a mesh rigidly.
 */
struct LabelVolume
{
  std::array<std::int64_t, 3> Dimensions{};
  std::array<double, 3> Spacing{};
  std::vector<std::uint16_t> Labels; ///< first axis fastest; 0 is background
};

/**
 * Reads an image of any format that ITK knows; values are converted to 16 bits.
 * @throws std::exception if ITK cannot read it
 */
LabelVolume ReadLabelVolume(const std::string& fileName);

} // namespace voxplex::benchmarks

#endif
