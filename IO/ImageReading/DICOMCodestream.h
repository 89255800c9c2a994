// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DICOMCodestream.h
 * @brief Frames that are compressed by JPEG, JPEG-LS or JPEG 2000. GDCM decompresses them.
 *
 * GDCM believes the header of the codestream where it differs from the header of the file, and gives what there is
 * when it ends too soon. So both are compared before, and the end is looked for.
 */
#ifndef voxplex_io_DICOMCodestream_h
#define voxplex_io_DICOMCodestream_h

#include "DICOMPixels.h"

namespace voxplex::io
{

/** @throws FileError: sizes that differ from the format, a missing end, damage */
DICOMFrame DecodeJPEG(const std::vector<std::byte>& packed, const DICOMPixelFormat& format);
DICOMFrame DecodeJPEGLS(const std::vector<std::byte>& packed, const DICOMPixelFormat& format);
DICOMFrame DecodeJPEG2000(const std::vector<std::byte>& packed, const DICOMPixelFormat& format);

} // namespace voxplex::io

#endif
