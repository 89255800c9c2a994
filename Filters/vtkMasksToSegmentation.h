// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMasksToSegmentation
 * @brief   several masks in memory, which may overlap, become one segmentation
 *
 * As vtkSegmentationReader does with masks in files: they become labels 1, 2, ... in their order, of unsigned short. A
 * mask is inside where it is not 0 (real numbers, from 0 to 1: above MaskThreshold).
 *
 * @par Input
 * Port 0, any number of connections: vtkImageData, or composites of them (vtkMultiBlockDataSet,
 * vtkPartitionedDataSetCollection), whose images count one after the other. The labels of an image are its active scalars
 * with one component, of points or cells, or its only such array. Field data SPACE, if there is one, says whether its
 * coordinates are LPS or RAS. Inputs are brought up to date when the pipeline asks for information, since only their
 * data tell the grid. Of inputs that change in time it joins the masks of the time that is asked for.
 *
 * @par Names
 * That of SetMaskName(), of the block, of the only label that the image's field data list (with its colour), or of the
 * array, unless several masks have an array of this name. Otherwise the label has none.
 *
 * @par Output
 * vtkImageData with the point scalars `Labels`, and with the field data of vtkSegmentationReader: `SPACE`,
 * `LabelValues`, `LabelNames`, `LabelColors`. It is in the coordinates of the first mask (LPS, if it does not say), on
 * the grid of the first, or if ResampleMasks is on of that with the smallest voxels, with the finest spacing along each
 * of its axes that a mask has, extended to all masks.
 *
 * @par Errors
 * Reported with vtkErrorMacro; GetErrorMessage() keeps the reason, and the output is empty: masks between voxels of others,
 * real numbers that are no probabilities, several arrays that could be meant, no input. What overlaps, and which masks
 * have no voxel, is reported with vtkWarningMacro, and kept for GetWarning(). If AbortExecute is set, the filter stops
 * before the next mask, and leaves the output empty.
 *
 * @sa vtkSegmentationReader
 */
#ifndef vtkMasksToSegmentation_h
#define vtkMasksToSegmentation_h

#include "vtkImageAlgorithm.h"
#include "vtkVoxplexModule.h" // For export macro

#include <map>    // For std::map
#include <string> // For std::string
#include <vector> // For std::vector

class VTKVOXPLEX_EXPORT vtkMasksToSegmentation : public vtkImageAlgorithm
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkMasksToSegmentation* New();
  vtkTypeMacro(vtkMasksToSegmentation, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /** The name of a mask, counted from 0 through all connections and blocks. By default there are none. */
  void SetMaskName(int mask, const char* name);
  void ClearMaskNames();
  ///@}

  ///@{
  /** Which of the masks that have a voxel gets it: the one with the fewest voxels (of equals the first), or the first. */
  enum
  {
    OVERLAP_SMALLEST = 0,
    OVERLAP_ORDER = 1
  };
  vtkSetClampMacro(Overlap, int, OVERLAP_SMALLEST, OVERLAP_ORDER);
  vtkGetMacro(Overlap, int);
  ///@}

  ///@{
  /** Above which real numbers of masks, which are probabilities, are inside: 0 to 1. Default 0.5. */
  vtkSetClampMacro(MaskThreshold, double, 0.0, 1.0);
  vtkGetMacro(MaskThreshold, double);
  ///@}

  ///@{
  /**
   * Whether masks on grids that differ by more than whole voxels are resampled to that with the smallest voxels, by
   * nearest neighbour. A warning counts voxels too far away to extend it (2^30 voxels, and 8 times the largest mask).
   * Default off: they are an error.
   */
  vtkSetMacro(ResampleMasks, bool);
  vtkGetMacro(ResampleMasks, bool);
  vtkBooleanMacro(ResampleMasks, bool);
  ///@}

  /** Why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

  ///@{
  /** What was odd, one line each. */
  int GetNumberOfWarnings() const { return static_cast<int>(this->Warnings.size()); }
  const std::string& GetWarning(int i) const;
  ///@}

protected:
  vtkMasksToSegmentation();
  ~vtkMasksToSegmentation() override;

  int FillInputPortInformation(int port, vtkInformation* information) override;
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkMasksToSegmentation(const vtkMasksToSegmentation&) = delete;
  void operator=(const vtkMasksToSegmentation&) = delete;

  void Announce(vtkInformationVector* masks, vtkInformation* output);
  void Join(vtkInformationVector* masks, vtkImageData* output);
  int Fail(vtkInformationVector* outputVector);

  std::map<int, std::string> MaskNames;
  int Overlap = OVERLAP_SMALLEST;
  double MaskThreshold = 0.5;
  bool ResampleMasks = false;
  std::string ErrorMessage;
  std::vector<std::string> Warnings;
};

#endif
