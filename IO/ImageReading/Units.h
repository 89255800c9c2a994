// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Units.h
 * @brief Units of lengths and times, as headers name them.
 *
 * Lengths and times are numbers as the file has them. If they are not in millimetres and seconds, the user must know.
 */
#ifndef voxplex_io_Units_h
#define voxplex_io_Units_h

#include "Placement.h"
#include "Readers.h"

#include <array>
#include <string>

namespace voxplex::io
{

/** Whether a text names a unit. A count of voxels measures nothing. */
bool IsUnitOfLength(const std::string& unit);

/**
 * What lengths along three axes are multiplied with to have the unit of the first. If that is not known, it is 1, and a
 * warning says so.
 */
Vector3 ToUnitOfFirst(const std::array<std::string, 3>& units, Reading& reading);

///@{
/** Unless it is the millimetre, or the second. @param unit empty if the file does not say */
void WarnOfLengths(const std::string& unit, Reading& reading);
void WarnOfTimes(const std::string& unit, Reading& reading);
///@}

} // namespace voxplex::io

#endif
