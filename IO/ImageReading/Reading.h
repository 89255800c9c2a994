// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Reading.h
 * @brief What the reader of a format is given, and what it tells besides the image.
 */
#ifndef voxplex_io_Reading_h
#define voxplex_io_Reading_h

#include "LabelTable.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace voxplex::io
{

/** One image is read with each. */
struct Reading
{
  /** Gives memory for so many bytes of voxels, in which nothing is set. */
  std::function<std::shared_ptr<void>(std::size_t bytes)> Allocate;

  /** Whether a header may name data files that are not in its folder or below. */
  bool DataFilesAnywhere = false;

  /** What was odd but could be read: a line each, without the name of the image. */
  std::vector<std::string> Warnings;

  /** Names and colours of labels, where the file has them. */
  LabelTable Labels;
};

/**
 * Lengths are numbers as the file has them, whatever their unit. If that is not the millimetre, the user must know.
 *
 * @param unit as the file writes it; empty if it does not say
 */
void WarnOfLengths(const std::string& unit, Reading& reading);

/** Where a header gives no spacing. */
void WarnOfSpacing(Reading& reading);

} // namespace voxplex::io

#endif
