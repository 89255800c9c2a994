// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChosenArray.h
 * @brief The array of an image that SetInputArrayToProcess() chose, checked.
 */
#ifndef voxplex_ChosenArray_h
#define voxplex_ChosenArray_h

#include "Private/ImageFrame.h"

#include "vtkDataArray.h"
#include "vtkSmartPointer.h"

#include <string>

class vtkAbstractArray;
class vtkImageData;

namespace voxplex
{

/** The kind of values that an image has. */
enum class ImageContent
{
  Labels,
  GreyValues ///< or other real numbers, such as sizes
};

/** An array of numbers on an image, one tuple for each voxel. */
struct ChosenArray
{
  vtkSmartPointer<vtkDataArray> Array;
  ImageFrame Frame;
};

/**
 * If the image hides voxels (HiddenVoxels.h), the result has a copy of the array, in which they are
 * background: the label 0, or NaN.
 *
 * @param chosen the array, null if there is none
 * @param association vtkDataObject::FIELD_ASSOCIATION_POINTS or _CELLS
 * @param what what the image is called in messages
 * @throws InputError if there is no array, if it does not hold numbers, if it has not as many tuples
 * as the image has voxels, and what MakeImageFrame() and FindHiddenVoxels() throw
 */
ChosenArray Choose(vtkImageData* image, vtkAbstractArray* chosen, int association,
  ImageContent content, const std::string& what);

/**
 * As Choose(), for an array of one component.
 * @param advice ends the message for several components
 * @throws InputError, for several components, too
 */
ChosenArray ChooseScalars(vtkImageData* image, vtkAbstractArray* chosen, int association,
  ImageContent content, const std::string& what, const std::string& advice);

/** The array itself if its values lie contiguously in memory in a type with a name, else a copy. */
vtkSmartPointer<vtkDataArray> Contiguous(vtkDataArray* array);

} // namespace voxplex

#endif
