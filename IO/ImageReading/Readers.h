// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Readers.h
 * @brief Two functions a format, each pair in a source file of its own name: one knows the format by the first bytes of
 * a file, and one reads the image.
 *
 * A reader throws FileError with the reason alone ("its header claims ..."): ReadImage() puts the name of the image
 * before it, and before warnings. All voxels that it returns are written by what the file says. What it has to guess it
 * warns of.
 */
#ifndef voxplex_io_Readers_h
#define voxplex_io_Readers_h

#include "FileError.h"
#include "InputFile.h"
#include "ReadImage.h"
#include "ScalarImage.h"

#include <string>
#include <vector>

namespace voxplex::io
{

/** One image is read with each, which collects what is said of it. */
struct Reading : ImageNotes
{
  ImageRequest Request;

  VoxelAllocator Allocate;

  /** Whether the file says where the image lies. A format that never does has no guess to tell. */
  bool HasPlace = true;

  /** Of lengths; empty: millimetres. */
  std::string Unit;

  /** What part has been read. @throws Stopped */
  void Tell(double part) const;
};

using Reader = ScalarImage (*)(const std::string& path, Reading& reading);

/** Calls a reader. @throws FileError with the reason alone, whatever the reader throws, or Stopped */
ImageAnswer ReadBy(Reader reader, Reading reading);

/** All formats, for the host: those that libraries read by ReadApart(). */
ScalarImage ReadFileOrFolder(const std::string& path, Reading& reading);
/** Calls ReadWithLibraries() in a process of its own. */
ScalarImage ReadApart(const std::string& path, Reading& reading);
/** DICOM, TIFF, VTK and folders of slices, for that process. */
ScalarImage ReadWithLibraries(const std::string& path, Reading& reading);

/** Where a header gives no spacing. */
void WarnOfSpacing(Reading& reading);

///@{
/**
 * NRRD (teem.sourceforge.net/nrrd/format.html), attached and detached. Encodings raw, gzip, text and hex. Spaces are
 * turned into LPS; those that do not say where left is (scanner-xyz, 3D-right-handed, 3D-left-handed, a space dimension
 * only) are taken for LPS, with a warning.
 *
 * A fourth axis of time is one of the space ("...-time"), of the kind time or list (3D Slicer's sequences, with the
 * times of their "axis 0 index values"), or the last of four that have no space. It may be at any place in the file.
 * Segments of 3D Slicer are given as labels; those in several layers are numbered in their order.
 */
bool IsNRRD(const InputFile& file);
ScalarImage ReadNRRD(const std::string& path, Reading& reading);
///@}

///@{
/**
 * NIfTI-1 and NIfTI-2 (nifti.nimh.nih.gov), in one file or two, and ANALYZE 7.5, from which they come. Of two files
 * either counts: the header beside what is called .img must be one. Each may be packed by gzip.
 *
 * The image lies where the sform says, if its code is positive, else where the qform says, if its code is; nibabel and
 * FSL do so, too. If both are there and differ, a warning tells by how much. If neither is, it lies along the axes of
 * RAS from 0, with a warning. Lengths in metres or micrometres are turned into millimetres, and times in milliseconds
 * or microseconds into seconds; numbers with no unit are those of the file, and so, with a warning, with another.
 * Voxels are scaled as scl_slope and scl_inter say. ANALYZE does not say how an image lies: along the axes of LPS, with
 * a warning.
 */
bool IsNIfTI(const InputFile& file);
ScalarImage ReadNIfTI(const std::string& path, Reading& reading);
///@}

///@{
/**
 * MetaImage (itk.org/Wiki/MetaIO/Documentation), a text that gives NDims. Binary, compressed and text voxels in one
 * file, one file a slice (LIST, patterns), or behind the header. A fourth axis is time. Coordinates are LPS.
 */
bool IsMetaImage(const InputFile& file);
ScalarImage ReadMetaImage(const std::string& path, Reading& reading);
///@}

///@{
/**
 * Volumes from DICOM: series of files with a slice each, and files with several frames.
 *
 * Slices are placed by Image Position and Orientation (Patient) and Pixel Spacing. Their files' names, order and
 * numbers do not matter. What has no place in space, or no single value a voxel, is refused with its name.
 *
 * Segmentations, binary, fractional and label maps, give labels that are the numbers of their segments, with names and
 * colours. Frames that are left out are background.
 */
bool IsDICOM(const InputFile& file);
ScalarImage ReadDICOMFile(const std::string& path, Reading& reading);
ScalarImage ReadDICOMFolder(const std::string& path, Reading& reading);
///@}

///@{
/**
 * Stacks of pages in a TIFF or BigTIFF file, by libtiff. Nothing but this file is opened.
 *
 * A page is a slice. All pages have the same size and type, and one sample a voxel: an integer of 8, 16, 32 or 64 bits,
 * a floating-point number of 32 or 64, or one bit. The numbers are those that are stored, whether 0 is shown black or
 * white (MinIsWhite). Reduced images and masks among the pages are passed over. What ImageJ, OME, SCIFIO or tifffile
 * write into the description says which page is which slice and frame, and how large voxels are; see TIFFStack.h.
 */
bool IsTIFF(const InputFile& file);
ScalarImage ReadTIFF(const std::string& path, Reading& reading);
/** A file with one page, without a place. */
ScalarImage ReadTIFFSlice(const std::string& path, Reading& reading);
///@}

///@{
/**
 * A slice of grey values of 1 to 16 bits, by libpng. The numbers are those that are stored, and not corrected by gamma.
 */
bool IsPNG(const InputFile& file);
ScalarImage ReadPNGSlice(const std::string& path, Reading& reading);
///@}

///@{
/**
 * A folder with a file for each slice, in the order of names, "s2" before "s10": TIFF or PNG. They have one size and
 * type, and numbers without gaps. Voxels are 1 x 1 x 1, with a warning.
 *
 * @return the files; none if one of the folder is DICOM
 */
std::vector<std::string> ListSlices(const std::string& folder);
ScalarImage ReadSlices(const std::vector<std::string>& files, Reading& reading);
///@}

///@{
/**
 * VTK's own images: legacy .vtk with the dataset STRUCTURED_POINTS, and XML .vti, by VTK's readers.
 *
 * TakeVTKImage() says what they mean.
 */
bool IsVTK(const InputFile& file);
ScalarImage ReadVTK(const std::string& path, Reading& reading);
///@}

///@{
/** Guy's Image Processing Lab, packed by gzip or not. Coordinates are LPS along the axes. */
bool IsGIPL(const InputFile& file);
ScalarImage ReadGIPL(const std::string& path, Reading& reading);
///@}

///@{
/**
 * FreeSurfer's volumes (.mgh, packed by gzip .mgz). Coordinates are turned into LPS. A header that does not say where
 * the image lies is one of coronal slices, with a warning. What is after the voxels is not read: frames have times
 * 0, 1, 2, ..., with a warning.
 */
bool IsMGH(const InputFile& file);
ScalarImage ReadMGH(const std::string& path, Reading& reading);
///@}

///@{
/**
 * Electron microscopy: MRC2014, and what programs before it wrote with the word "MAP ". Modes 0, 1, 2 and 6. Bytes are
 * signed, as MRC2014 has them, unless IMOD says otherwise; if the header is older and some are negative, there is a
 * warning. Columns, rows and sections may run along any of the axes. Lengths are in angstrom, with a warning. If the
 * cell is 0, the spacing is 1, with a warning.
 */
bool IsMRC(const InputFile& file);
ScalarImage ReadMRC(const std::string& path, Reading& reading);
///@}

} // namespace voxplex::io

#endif
