// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPVLabelInformation
 * @brief   the labels of a data set, their names, colours and voxels, gathered from the server
 *
 * The data set says them in its field data: `LabelValues` (integers), `LabelNames` (strings, or their bytes),
 * `LabelColors` (3 components from 0 to 1, optional; a NaN row means none), all of the same length. What
 * is wrongly formed is ignored. Besides, the values that occur in the cell array `Label` are gathered, so that labels without a
 * name can be listed, too. Those of an image are counted if an array is chosen (SetArray()).
 *
 * The object to gather from is an algorithm; its output PortNumber is taken. Field data does not travel in
 * vtkPVDataInformation, which knows the arrays' names only.
 */
#ifndef vtkPVLabelInformation_h
#define vtkPVLabelInformation_h

#include "vtkPVInformation.h"
#include "vtkVoxplexServerManagerModule.h" // For export macro

#include <array>  // For std::array
#include <map>    // For std::map
#include <string> // For std::string

class vtkDataObject;
class vtkFieldData;
class vtkImageData;

class VTKVOXPLEXSERVERMANAGER_EXPORT vtkPVLabelInformation : public vtkPVInformation
{
public:
  static vtkPVLabelInformation* New();
  vtkTypeMacro(vtkPVLabelInformation, vtkPVInformation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The output to look at. Default 0. */
  vtkSetMacro(PortNumber, int);
  vtkGetMacro(PortNumber, int);
  ///@}

  /**
   * The array of an image whose labels are counted. An empty name means the default of
   * vtkImageToSimplexMeshFilter. At first nothing is counted.
   * @param association vtkDataObject::FIELD_ASSOCIATION_POINTS or _CELLS
   */
  void SetArray(int association, const std::string& name)
  {
    this->Association = association;
    this->ArrayName = name;
  }

  /** Why no labels were counted, for the user; empty if they were, and if there was no image. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

  void CopyFromObject(vtkObject* object) override;
  void AddInformation(vtkPVInformation* other) override;
  void CopyToStream(vtkClientServerStream* stream) override;
  void CopyFromStream(const vtkClientServerStream* stream) override;
  void CopyParametersToStream(vtkMultiProcessStream& stream) override;
  void CopyParametersFromStream(vtkMultiProcessStream& stream) override;

#ifndef __VTK_WRAP__
  struct LabelEntry
  {
    std::string Name; ///< empty if it has none
    bool HasColor = false;
    std::array<double, 3> Color{};
    vtkTypeInt64 Voxels = 0; ///< those that were counted

    bool operator==(const LabelEntry& other) const
    {
      return this->Name == other.Name && this->HasColor == other.HasColor &&
        this->Color == other.Color && this->Voxels == other.Voxels;
    }
  };
  using LabelMap = std::map<vtkTypeInt64, LabelEntry>;

  /** By the label's value; background is not among them. */
  const LabelMap& GetLabels() const
  {
    return this->Labels;
  }
#endif

protected:
  vtkPVLabelInformation() = default;
  ~vtkPVLabelInformation() override = default;

private:
  vtkPVLabelInformation(const vtkPVLabelInformation&) = delete;
  void operator=(const vtkPVLabelInformation&) = delete;

  void ReadTable(vtkFieldData* fields);
  void ReadCells(vtkDataObject* data);
  void ReadVoxels(vtkImageData* image);

  int PortNumber = 0;
  int Association = -1; ///< of points or of cells; or nothing is counted
  std::string ArrayName;
  std::string ErrorMessage;
#ifndef __VTK_WRAP__
  LabelMap Labels;
#endif
};

#endif
