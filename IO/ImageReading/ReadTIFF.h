// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReadTIFF.h
 * @brief Stacks of pages in a TIFF or BigTIFF file, by libtiff.
 *
 * A page is a slice. All pages have the same size and type, and one sample a voxel: an integer of 8, 16, 32 or 64 bits,
 * a floating-point number of 32 or 64, or one bit. The numbers are those that are stored, whether 0 is shown black or
 * white (MinIsWhite). Reduced images and masks among the pages are passed over. What ImageJ, OME, SCIFIO or tifffile
 * write into the description says which page is which slice and frame, and how large voxels are; see TIFFStack.h.
 */
#ifndef voxplex_io_ReadTIFF_h
#define voxplex_io_ReadTIFF_h

#include "InputFile.h"
#include "Reading.h"
#include "ScalarImage.h"

#include <string>

namespace voxplex::io
{

/** By its first four bytes. */
bool IsTIFF(const InputFile& file);

/**
 * Nothing but this file is opened.
 *
 * @throws FileError: several samples or colours, types other than those above, pages that differ, one slice alone,
 * several channels or images, metadata that do not fit the pages, a compression that libtiff lacks, damage
 */
ScalarImage ReadTIFF(const std::string& path, Reading& reading);

} // namespace voxplex::io

#endif
