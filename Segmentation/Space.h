// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Space.h
 * @brief The patient coordinate systems that images and meshes lie in, and the field data that say which.
 */
#ifndef voxplex_Space_h
#define voxplex_Space_h

#include <array>
#include <optional>
#include <string>

class vtkFieldData;

namespace voxplex
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

/**
 * As the array SPACE says, a text that vtkSegmentationReader and 3D Slicer write; LPS if there is none.
 * @param unknown receives another text, which is taken for LPS; may be null
 */
Space GetSpace(vtkFieldData* fields, std::optional<std::string>* unknown = nullptr);

/** Adds the array SPACE. */
void SetSpace(vtkFieldData* fields, Space space);

} // namespace voxplex

#endif
