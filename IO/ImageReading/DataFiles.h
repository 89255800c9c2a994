// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DataFiles.h
 * @brief The files that hold the voxels of an image, and how much they can hold.
 *
 * ITK takes memory for all voxels that a header claims before it looks for them, and opens any
 * file that the header names. The headers come from strangers.
 */
#ifndef voxplex_io_DataFiles_h
#define voxplex_io_DataFiles_h

#include <string>
#include <vector>

namespace itk
{
class ImageIOBase;
}

namespace voxplex::io
{

/**
 * Checks the files that the text header of an NRRD or MetaImage file names: regular files that exist, and
 * patterns of names with one number in them. To be called before ITK reads the header.
 *
 * @return what is wrong, or an empty string
 */
std::string FindFaultOfNamedFiles(const std::string& path);

/**
 * Compares what a header claims with the sizes of the files that hold the voxels. To be called when ITK
 * has read the header, and before it reads voxels.
 *
 * A byte of a file holds a byte of voxels, or, compressed, at most 1032 (deflate's limit: gzip, zlib, PNG);
 * 65536 where the compression is another or not known (TIFF, HDF5, DICOM that is not plain).
 *
 * @param files the image's file, or the slices of a series, all as large as the first
 * @return what is wrong, or an empty string
 */
std::string FindFaultOfSize(const std::vector<std::string>& files, const itk::ImageIOBase& io);

} // namespace voxplex::io

#endif
