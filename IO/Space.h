// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Space.h
 * @brief The patient coordinate systems that images and meshes lie in.
 */
#ifndef voxplex_io_Space_h
#define voxplex_io_Space_h

#include <array>

namespace voxplex::io
{

/** LPS is that of DICOM and ITK, RAS that of NIfTI. */
enum class Space
{
  LPS,
  RAS
};

inline const char* ToString(Space space)
{
  return space == Space::LPS ? "LPS" : "RAS";
}

/** The factors between coordinates in LPS and those in another space, both ways. */
inline std::array<double, 3> SignsFromLPS(Space space)
{
  return space == Space::LPS ? std::array<double, 3>{ 1.0, 1.0, 1.0 }
                             : std::array<double, 3>{ -1.0, -1.0, 1.0 };
}

} // namespace voxplex::io

#endif
