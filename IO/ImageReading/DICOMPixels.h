// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DICOMPixels.h
 * @brief The pixels of a DICOM file, of one value each, frame by frame. GDCM decompresses JPEG, JPEG-LS and JPEG 2000.
 */
#ifndef voxplex_io_DICOMPixels_h
#define voxplex_io_DICOMPixels_h

#include "DICOMDataSet.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace voxplex::io
{

/** What the Image Pixel module says. */
struct DICOMPixelFormat
{
  unsigned Rows = 0;
  unsigned Columns = 0;
  unsigned BitsAllocated = 0; ///< 8, 16 or 32; of segments 1 or 8
  unsigned BitsStored = 0;
  unsigned HighBit = 0;
  bool IsSigned = false;

  bool operator==(const DICOMPixelFormat&) const = default;
  std::uint64_t Pixels() const { return std::uint64_t(this->Rows) * this->Columns; }
  std::uint64_t BytesOfSample() const { return std::max(1U, this->BitsAllocated / 8); }
  std::uint64_t BytesOfFrame() const { return this->Pixels() * this->BytesOfSample(); }
  /** In the file, where eight bits make a byte. */
  std::uint64_t StoredBytesOfFrame() const
  {
    return (this->Pixels() * this->BitsAllocated + 7) / 8;
  }
};

/** One frame. Each sample has bits that do not belong to it above its high bit, and maybe below; one bit has a byte. */
struct DICOMFrame
{
  std::vector<std::byte> Samples; ///< little endian
  std::size_t BytesOfSample = 1;
  bool IsLossy = false; ///< by what is compressed itself
};

/**
 * Whether it is a segmentation of the kind label map. Its values are labels, also where a palette gives them colours,
 * and slices without labels may have been left out.
 */
bool IsLabelMap(const DICOMDataSet& data);

/** Whether it is a segmentation whose segments have frames of their own, of one bit or of fractions. */
bool HasFramesOfSegments(const DICOMDataSet& data);

class DICOMPixels
{
public:
  /**
   * Checks that the file can hold what its header claims, before memory is taken for it.
   * @throws FileError: pixels that have no values, that are missing, or of a compression that is not supported
   */
  explicit DICOMPixels(const DICOMDataSet& data);

  const DICOMPixelFormat& Format() const { return this->Layout; }
  int Frames() const { return this->NumberOfFrames; }
  bool IsLossy() const { return this->WasLossy; }

  /** @throws FileError for damage */
  DICOMFrame Read(int frame) const;

private:
  enum class Compression
  {
    None,
    RLE,
    Deflate,
    JPEG,
    JPEGLS,
    JPEG2000
  };
  void ChooseCompression(const std::string& syntax, const std::string& lossy);
  void CheckRawLength(const DICOMElement& pixels) const;
  void FindFrames(const DICOMElement& pixels);
  void CheckRatio() const;
  std::vector<std::byte> ReadStored(std::uint64_t offset, std::size_t size) const;
  DICOMFrame ReadRaw(int frame) const;
  DICOMFrame ReadBytesOfFrame(int frame) const;
  std::vector<std::byte> ReadFragments(int frame) const;

  const DICOMDataSet& Data;
  DICOMPixelFormat Layout;
  int NumberOfFrames = 1;
  bool WasLossy = false;
  Compression Method = Compression::None;
  std::uint64_t Begin = 0;      ///< of pixels that are not compressed
  bool AreBytesSwapped = false; ///< in words of 16 bits
  std::vector<std::vector<DICOMElement>> FragmentsOfFrames;
};

///@{
/**
 * Frames that are compressed by JPEG, JPEG-LS or JPEG 2000. GDCM believes the header of the codestream where it differs
 * from the header of the file, and gives what there is when it ends too soon. So both are compared before, and the end
 * is looked for.
 *
 * @throws FileError: sizes that differ from the format, a missing end, damage
 */
DICOMFrame DecodeJPEG(const std::vector<std::byte>& packed, const DICOMPixelFormat& format);
DICOMFrame DecodeJPEGLS(const std::vector<std::byte>& packed, const DICOMPixelFormat& format);
DICOMFrame DecodeJPEG2000(const std::vector<std::byte>& packed, const DICOMPixelFormat& format);
///@}

} // namespace voxplex::io

#endif
