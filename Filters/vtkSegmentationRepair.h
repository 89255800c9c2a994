// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSegmentationRepair
 * @brief   repairs a label image on request, and says what is suspicious about it
 *
 * Operations are off by default, and are done in the order in which they stand here.
 *
 * @par Input and outputs
 * Port 0: a label image of three dimensions, 0 is background; SetInputArrayToProcess(0, ...) chooses an array, by
 * default the active scalars of points or cells. Frames of a series are repaired one by one. Output 0 is the image with
 * its labels changed, in a larger type if a new label needs it; before an execution, this type is known if
 * FirstShellLabel is set. Output 1 is a vtkTable, a row for each operation and
 * label that it changed: `What`, `Label`, `Name`, `Voxels` that were changed, `Places` (sets of them that faces
 * connect), `Largest` (voxels of the largest place), `First` and `Last`, the corners of its bounding box as indices of
 * voxels from 0 on, `LeftOut` (voxels that an operation wanted, and that have to stay as they are), `TouchingFaces` (of
 * voxels, see Shell).
 *
 * @par FillHoles
 * A cavity is a set of background voxels, connected through faces, that does not touch the border of the image.
 * Cavities of at most FillHoles voxels get the label that has most of the faces around them. Islands of other labels
 * stay; the meshing filters' MinimumComponentVolume is for these.
 *
 * @par RemoveSpikes
 * What opening takes from a label, if it touches the rest at one place. Opening is by squares of 2 x 2 voxels in the
 * three planes: it takes strings that are one voxel wide, and no sheet. What touches the rest at several places
 * (arches, and what connects two parts of a label) stays but for its loose ends, and so does a component that opening
 * would take as a whole. The voxels get the label of most faces around them, or become background. Voxels beyond the
 * border count as those of the label, but a string that ends there is a spike.
 *
 * @par MinimumThickness
 * Where a label is thinner than a length, it is thickened to at least that; oblique sheets to half a voxel less or
 * more. A place is thin if it is farther than the length from where a ball of this diameter fits into the label. Balls
 * of this diameter around the middle of thin places are added. They replace background and other labels, but no label
 * that has a smallest thickness itself, and no whole component. A ball that would reach one of these moves away from
 * it, by up to 3/4 of the length, so that the free side grows. Where there is no room the label stays thinner: a
 * warning has the number of voxels that it lacks. What is beyond the border of the image counts as the label.
 *
 * @par Shell
 * A positive thickness adds a new label around a label, in background. A voxel belongs to it if its centre is in an
 * ellipsoid around the centre of a voxel of the label, whose half axes are the thickness and half a voxel. If the
 * thickness is at least half the longest edge of a voxel, so do all voxels that share a face, an edge or a corner with
 * the label, and the shell is closed. If it is less, a warning has the number of faces between the label and
 * background. Where two shells meet, they share the gap in proportion to their thicknesses; a voxel in the middle is
 * that of the smaller label. A negative thickness is that of a shell inside: voxels of the label itself become the new
 * label, by their distance from other labels and background, also from those that the label encloses. New labels are
 * FirstShellLabel and those that follow, by default from the highest label, of voxels and in the field data array
 * `LabelValues`, plus one. `LabelNames` gets "NAME shell".
 *
 * @par CheckImage
 * Output 1 then has rows for what is suspicious after the repair, too; nothing is changed. What is: `components` beside
 * the largest of a label, `crumbs` (components of fewer than 8 voxels), `cavities`, `spikes`, `thin` (parts thinner
 * than two voxels), `necks` (parts thinner than three voxels that connect thicker ones), `gaps` (background thinner
 * than two voxels, at each label beside it), `contacts` (voxels that meet at an edge or corner only; counted are
 * voxels), `border` (voxels at the border of the image), `absent` (named labels without voxels), `unnamed` (labels
 * without a name, if others have one).
 *
 * Lengths are in the unit of the spacing, along the image's axes, which are taken for orthogonal.
 *
 * @par Errors
 * Misuse is reported with vtkErrorMacro and leaves the outputs empty; GetErrorMessage() keeps the reason. A label
 * without voxels is an error, but not in a series.
 *
 * Time is linear in the voxels, for each MinimumThickness and Shell in those of the label's bounding box; memory is
 * about 10 bytes a voxel beside both images, 20 with shells. MinimumThickness needs 80 more for each voxel of a block;
 * along each axis this has 11 times the length, or 64 voxels and 6 times the length, or the whole image. If
 * AbortExecute is set, the filter stops and leaves the outputs empty.
 */
#ifndef vtkSegmentationRepair_h
#define vtkSegmentationRepair_h

#include "vtkImageAlgorithm.h"
#include "vtkVoxplexModule.h" // For export macro

#include <memory> // For std::unique_ptr
#include <string> // For std::string

class vtkTable;

namespace voxplex
{
class SegmentationRepair;
}

class VTKVOXPLEX_EXPORT vtkSegmentationRepair : public vtkImageAlgorithm
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkSegmentationRepair* New();
  vtkTypeMacro(vtkSegmentationRepair, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /** An empty name means the default, as in vtkImageToSimplexMeshFilter. */
  void SetInputArrayToProcess(
    int index, int port, int connection, int association, const char* name) override;
  using vtkImageAlgorithm::SetInputArrayToProcess;
  ///@}

  ///@{
  /** The largest cavity to fill, in voxels. Default 0: none. */
  vtkSetMacro(FillHoles, int);
  vtkGetMacro(FillHoles, int);
  ///@}

  ///@{
  /** Default off. */
  vtkSetMacro(RemoveSpikes, bool);
  vtkGetMacro(RemoveSpikes, bool);
  vtkBooleanMacro(RemoveSpikes, bool);
  ///@}

  ///@{
  /**
   * A smallest thickness of a label, positive; the getter returns 0 if the label has none. GetThickenedLabel() numbers
   * those that have one, in increasing order; it returns 0 if the index is out of range.
   */
  void SetMinimumThickness(vtkTypeInt64 label, double length);
  double GetMinimumThickness(vtkTypeInt64 label) const;
  void RemoveMinimumThickness(vtkTypeInt64 label);
  void ClearMinimumThicknesses();
  int GetNumberOfMinimumThicknesses() const;
  vtkTypeInt64 GetThickenedLabel(int index) const;
  ///@}

  ///@{
  /** The thickness of a shell, negative for one inside of the label; the others as for MinimumThickness. */
  void SetShell(vtkTypeInt64 label, double thickness);
  double GetShell(vtkTypeInt64 label) const;
  void RemoveShell(vtkTypeInt64 label);
  void ClearShells();
  int GetNumberOfShells() const;
  vtkTypeInt64 GetShelledLabel(int index) const;
  ///@}

  ///@{
  /** The new label of the first shell, in the order of labels. Default 0: see above. */
  vtkSetMacro(FirstShellLabel, vtkTypeInt64);
  vtkGetMacro(FirstShellLabel, vtkTypeInt64);
  ///@}

  ///@{
  /** Default off. */
  vtkSetMacro(CheckImage, bool);
  vtkGetMacro(CheckImage, bool);
  vtkBooleanMacro(CheckImage, bool);
  ///@}

  ///@{
  /** Threads; 0 for as many as vtkSMPTools uses. No result depends on it. Default 0. */
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /** What messages call parameters: a value of vtkImageToSimplexMeshFilter::VOCABULARY_VTK and those beside it. */
  vtkSetClampMacro(Vocabulary, int, 0, 5);
  vtkGetMacro(Vocabulary, int);
  ///@}

  /** Output 1. */
  vtkTable* GetReportTable();
  /** Output 1 in words, a line for each row, but of at most 20 labels for each kind. */
  std::string GetReport();
  /** Output 1 as JSON: a list of objects with what, label, voxels, places, largest, first, last, of shells new_label, and if they are
   * not 0 left_out and touching_faces. */
  std::string ToJSON();

  /** Why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

  ///@{
  /** What the last execution could not do, as it was reported. */
  int GetNumberOfWarnings() const;
  const std::string& GetWarning(int i) const;
  ///@}

protected:
  vtkSegmentationRepair();
  ~vtkSegmentationRepair() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

private:
  vtkSegmentationRepair(const vtkSegmentationRepair&) = delete;
  void operator=(const vtkSegmentationRepair&) = delete;

  class Internals;
  void Repair(vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  void CheckParameters() const;
  bool IsIdle() const;
  void Change(voxplex::SegmentationRepair& image);
  void Proceed(double fraction);

  int FillHoles = 0;
  bool RemoveSpikes = false;
  bool CheckImage = false;
  vtkTypeInt64 FirstShellLabel = 0;
  int NumberOfThreads = 0;
  int Vocabulary = 0;
  std::string ErrorMessage;
  std::unique_ptr<Internals> Private;
};

#endif
