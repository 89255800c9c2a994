// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OMEMetadata.h
 * @brief The metadata of an OME-TIFF file.
 */
#ifndef voxplex_io_OMEMetadata_h
#define voxplex_io_OMEMetadata_h

#include "XMLParser.h"

#include <cstddef>
#include <string>
#include <vector>

namespace voxplex::io
{

struct OMEMetadata
{
  /** A TiffData element: which planes are in which directories. */
  struct Planes
  {
    TextFields Fields;
    std::string File;     ///< the UUID of the file that they are in; may be empty
    std::string FileName; ///< its name, if that is known
  };

  std::string File;             ///< the UUID of this file; may be empty
  std::string CompanionFile;    ///< which has all the metadata; empty if this one has them
  std::size_t Images = 0;       ///< how many
  TextFields Pixels;            ///< of the first image
  std::vector<Planes> TiffData; ///< of the first image
};

/** Whether a description is meant as OME's. */
bool IsOMEMetadata(const std::string& description);

/** Reads nothing but the text. @throws FileError if it is no well-formed XML, or has a document type */
OMEMetadata ParseOMEMetadata(const std::string& description);

} // namespace voxplex::io

#endif
