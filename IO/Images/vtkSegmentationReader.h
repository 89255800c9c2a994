// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSegmentationReader
 * @brief   reads a segmentation with its place in space, its times and the names of its labels
 *
 * Reads one file, or a folder with a DICOM series, in three or four dimensions, the fourth being time. The first bytes
 * of a file tell its format, not its name: NRRD, NIfTI, ANALYZE, MetaImage, DICOM, TIFF, VTK (.vtk, .vti), MGH, GIPL,
 * MRC.
 * Documentation/FileFormats.md says what each of them tells about the place of the image, and what is done where it
 * does not.
 *
 * @par Masks
 * Several files, and those of a folder of images that are not DICOM, are masks, one for each structure, inside where
 * they are not 0 (real numbers, from 0 to 1: above MaskThreshold). They become labels 1, 2, ... of one image of
 * unsigned short, in the order given, or that of names in a folder (rib_2 before rib_10), and have the names of their
 * files. So do segments of a .seg.nrrd file that overlap. Segments of a DICOM segmentation keep their numbers. A
 * warning tells what overlaps, and which masks are without a voxel. Beside the result, of 2 bytes a voxel, one mask is
 * in memory at a time.
 *
 * @par Output
 * vtkImageData with origin, spacing and direction matrix as in the file, in the coordinates that Space
 * asks for. The point scalars are called `Labels`; they have one component and the type of the file. The
 * voxels are not copied: the output shares the memory that the file was read into.
 *
 * Field data:
 * - `SPACE`: vtkStringArray with one value, "LPS" or "RAS", which 3D Slicer reads;
 * - `LabelValues`, `LabelNames`, `LabelColors`: names and colours of the labels, where they are known:
 *   vtkIntArray (vtkLongLongArray if a value does not fit), vtkStringArray, and vtkDoubleArray with three
 *   components in [0, 1], NaN for a label without a colour, left out if none has one. The background 0
 *   is not listed, nor are labels without names, and names of labels that no voxel has.
 *
 * The meshing filters pass field data on to the mesh.
 *
 * @par Time
 * An image of several frames announces `TIME_STEPS` and `TIME_RANGE`. The output is the frame that
 * is nearest to `UPDATE_TIME_STEP`, the first one if no time is asked for. Frames may have any times that increase.
 *
 * @par Errors
 * What cannot be read is reported with vtkErrorMacro and leaves the output empty; GetErrorMessage()
 * keeps the reason: no such file, unknown format, truncated or damaged data, several components that are
 * not frames, more than four dimensions, a spacing that is not positive, a singular direction matrix,
 * several DICOM series and no SeriesUID, masks between voxels of others, a file that made the reading process crash or
 * take too long. What was odd but could be read is reported with vtkWarningMacro, and kept for GetWarning().
 *
 * @par When it reads
 * The whole file is read when the pipeline first asks for information, so that damage is known before
 * anything is computed, and kept until the reader is modified, except by SetSpace(). Call Modified() to read a file again
 * that has changed.
 *
 * @par Progress and abort
 * Progress is the part of the voxels that has been read, and of masks the part of the files; what the reading process
 * does is known at its end only. If a progress observer sets AbortExecute, reading stops within a fraction of a second,
 * the reading process ends, and the output is empty; GetAborted() then returns true. Modified() has it read again.
 *
 * @par The reading process
 * DICOM, TIFF, VTK's files and folders of slices are read by libraries, in a program of its own (voxplexImageReader,
 * beside this library), which may open no other files and has limits of memory and time; it hands over the voxels in
 * shared memory. Whatever a damaged file does to a library, this process lives and has a message. If the process cannot
 * be started, there is an error, and no image. The other formats are read in this process, by code of voxplex.
 *
 * @par Thread safety
 * Distinct instances may execute at the same time.
 */
#ifndef vtkSegmentationReader_h
#define vtkSegmentationReader_h

#include "vtkImageAlgorithm.h"
#include "vtkVoxplexIOModule.h" // For export macro
#include "vtkWrappingHints.h"   // For VTK_FILEPATH

#include <memory> // For std::unique_ptr
#include <string> // For std::string
#include <vector> // For std::vector

class VTKVOXPLEXIO_EXPORT vtkSegmentationReader : public vtkImageAlgorithm
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkSegmentationReader* New();
  vtkTypeMacro(vtkSegmentationReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  /** Coordinates of the output. LPS are those of DICOM and ITK, RAS those of NIfTI and 3D Slicer's scene. */
  enum
  {
    SPACE_LPS = 0,
    SPACE_RAS = 1
  };

  ///@{
  /** A file, or a folder with a DICOM series or with masks. */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /** Masks, one file after the other, in place of FileName. One alone is read as FileName is. */
  void AddFileName(VTK_FILEPATH const char* name);
  void ClearFileNames();
  ///@}

  /** Which of the masks that have a voxel gets it: the one with the fewest voxels (of equals the first), or the first. */
  enum
  {
    OVERLAP_SMALLEST = 0,
    OVERLAP_ORDER = 1
  };

  ///@{
  /** OVERLAP_SMALLEST (default) or OVERLAP_ORDER. */
  vtkSetClampMacro(Overlap, int, OVERLAP_SMALLEST, OVERLAP_ORDER);
  vtkGetMacro(Overlap, int);
  ///@}

  ///@{
  /** Above which probabilities, from 0 to 1, are inside: of masks, and of fractional DICOM segmentations. Default 0.5. */
  vtkSetClampMacro(MaskThreshold, double, 0.0, 1.0);
  vtkGetMacro(MaskThreshold, double);
  ///@}

  ///@{
  /**
   * Whether masks whose grids differ by more than whole voxels are resampled to the smallest voxels, by nearest
   * neighbour. If grids differ, all files are read twice. Default off: they are an error.
   */
  vtkSetMacro(ResampleMasks, bool);
  vtkGetMacro(ResampleMasks, bool);
  vtkBooleanMacro(ResampleMasks, bool);
  ///@}

  ///@{
  /** Which DICOM series to read, if the folder holds several: its UID or the beginning of it. */
  vtkSetStringMacro(SeriesUID);
  vtkGetStringMacro(SeriesUID);
  ///@}

  ///@{
  /**
   * A text table with names and colours of the labels: that of an atlas, or of FreeSurfer, ITK-SNAP or
   * 3D Slicer, or `value name` or `value,name,red,green,blue` in each line. Documentation/FileFormats.md
   * describes them. Default none: names are then those that the image has itself (3D Slicer's .seg.nrrd, field
   * data of VTK's), or, if it has none, those of a table of the same name beside it: x.nii.txt beside
   * x.nii.gz. If that is no table, there is a warning and it is not used; a table that is set here must be one.
   */
  vtkSetFilePathMacro(LabelTableFileName);
  vtkGetFilePathMacro(LabelTableFileName);
  ///@}

  ///@{
  /** SPACE_LPS (default) or SPACE_RAS. */
  void SetSpace(int space);
  vtkGetMacro(Space, int);
  ///@}

  ///@{
  /**
   * The distances of voxels along each axis, the place of the first voxel, and the directions of the axes (nine
   * numbers, row by row, whose columns are the directions, of any length), in place of those of the file: for formats
   * that do not know them (TIFF), and for files that are wrong. Place and directions are in the coordinates of Space.
   * What is not positive (spacing), NaN (origin; ClearOrigin() makes it so) or all 0 (direction) is taken from the
   * file: so is everything by default.
   */
  vtkSetVector3Macro(Spacing, double);
  vtkGetVector3Macro(Spacing, double);
  vtkSetVector3Macro(Origin, double);
  vtkGetVector3Macro(Origin, double);
  void ClearOrigin();
  vtkSetVectorMacro(Direction, double, 9);
  vtkGetVectorMacro(Direction, double, 9);
  ///@}

  ///@{
  /**
   * Whether the header of an image (.nhdr, .mhd, .hdr) may name data files anywhere. Default off: such files must be
   * in the folder of the header or below, since a header from a stranger could name any file of the user's.
   */
  vtkSetMacro(DataFilesAnywhere, bool);
  vtkGetMacro(DataFilesAnywhere, bool);
  vtkBooleanMacro(DataFilesAnywhere, bool);
  ///@}

  ///@{
  /**
   * The times of the frames, one after the other, increasing, in place of those of the file. By
   * default there are none.
   */
  void AddFrameTime(double time);
  void ClearFrameTimes();
  ///@}

  ///@{
  /**
   * What was read, valid after UpdateInformation() or Update(): the number of frames, 1 for a 3D image
   * and 0 if nothing could be read, and the time of each.
   */
  int GetNumberOfFrames() const;
  double GetTimeOfFrame(int frame) const;
  ///@}

  /** The file that the names of labels are from, which may be the image (the first of masks); empty if there are none. */
  const std::string& GetLabelTableSource() const;

  /** All files that voxels and names were read from: of a folder its images, and what headers name. */
  std::vector<std::string> GetFilesRead() const;

  /** Whether the last reading was stopped by AbortExecute. */
  bool GetAborted() const { return this->Aborted; }

  /** Why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

  ///@{
  /** What was odd but could be read, one line each. */
  int GetNumberOfWarnings() const;
  const std::string& GetWarning(int i) const;
  ///@}

protected:
  vtkSegmentationReader();
  ~vtkSegmentationReader() override;

  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  char* FileName;
  std::vector<std::string> FileNames;
  int Overlap;
  double MaskThreshold;
  bool ResampleMasks;
  char* SeriesUID;
  char* LabelTableFileName;
  int Space;
  double Spacing[3];
  double Origin[3];
  double Direction[9];
  bool DataFilesAnywhere;
  std::vector<double> FrameTimes;

private:
  vtkSegmentationReader(const vtkSegmentationReader&) = delete;
  void operator=(const vtkSegmentationReader&) = delete;

  bool IsPlaced() const;
  bool IsRead() const;
  bool Read();
  void ReadLabels();
  void PlaceImage();

  std::string ErrorMessage;
  bool Aborted = false;

  struct Internals;
  std::unique_ptr<Internals> Private;
};

#endif
