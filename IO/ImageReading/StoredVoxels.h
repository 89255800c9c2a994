// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StoredVoxels.h
 * @brief Voxels as files hold them: raw, compressed by zlib, or as text.
 *
 * What NRRD, NIfTI, MetaImage, MGH, GIPL and MRC have in common: a header, and then numbers.
 */
#ifndef voxplex_io_StoredVoxels_h
#define voxplex_io_StoredVoxels_h

#include "ScalarImage.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace voxplex::io
{

class InputFile;
struct Reading;

enum class Encoding
{
  Raw,
  Deflate, ///< zlib or gzip, which the first bytes tell
  Text,    ///< decimal numbers; blanks, line ends and commas separate
  Hex      ///< two digits a byte
};

/** Where the voxels are and how they are written. Several files hold equally many each, one after the other. */
struct StoredVoxels
{
  static constexpr std::int64_t FromTheEnd = -1;

  Encoding Coding = Encoding::Raw;
  bool IsBigEndian = false;
  std::vector<std::string> Files;
  std::int64_t Offset =
    0; ///< of the first voxel in each file, of compressed ones where compression begins
  std::int64_t LinesToSkip = 0; ///< from Offset on, before they are unpacked
  std::int64_t BytesToSkip =
    0; ///< after that, of what is unpacked; FromTheEnd: the voxels are the last bytes (raw only)
};

/**
 * Reads as many voxels as the sizes of the image ask for into its Scalars, and turns them into this machine's byte
 * order.
 *
 * @throws FileError: files that hold fewer, damaged compression (checksums included), texts that are not numbers of
 * the type; before memory is taken if the files are too small for what the header claims (deflate packs 1032 bytes
 * into one at most)
 */
void ReadVoxels(const StoredVoxels& stored, ScalarImage& image, Reading& reading);

/**
 * Puts the axis of frames last. In the file it comes after `before` others, whose sizes are the first of the image.
 */
void MoveFramesToTheEnd(ScalarImage& image, std::size_t before, Reading& reading);

/**
 * Replaces each voxel by slope * voxel + intercept, as NIfTI and DICOM mean it. Integers remain integers, in a type
 * that holds the results, if both numbers are whole; else the results are of type Float64.
 */
void Rescale(ScalarImage& image, double slope, double intercept, Reading& reading);

/**
 * The path of a file that a header names: beside the header or below.
 *
 * @param anywhere allows all other places
 * @throws FileError for absolute names, "..", links that lead elsewhere
 */
std::string FindDataFile(const std::string& header, const std::string& name, bool anywhere);

/** Unpacks a file by its content: the bytes of a gzip file, or those of another. What is missing at the end is left
 * out. */
std::string UnpackBeginning(const InputFile& file, std::size_t length);

} // namespace voxplex::io

#endif
