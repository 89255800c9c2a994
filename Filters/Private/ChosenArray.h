// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChosenArray.h
 * @brief The array of an image that SetInputArrayToProcess() chose, checked.
 */
#ifndef voxplex_ChosenArray_h
#define voxplex_ChosenArray_h

#include "Image/ImageFrame.h"
#include "Image/LabelImage.h"
#include "Image/Series/FrameSeries.h"

#include "vtkDataArray.h"
#include "vtkSmartPointer.h"

#include <cstdint>
#include <stop_token>
#include <string>

class vtkAbstractArray;
class vtkImageData;
class vtkInformation;

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
 * If the image hides voxels (ImageVoxels.h), the result has a copy of the array, in which they are
 * background: the label 0, or NaN.
 *
 * @param chosen the array, null if there is none
 * @param association vtkDataObject::FIELD_ASSOCIATION_POINTS or _CELLS
 * @param what what the image is called in messages
 * @throws InputError if there is no array, if it does not hold numbers, if it has not as many tuples
 * as the image has voxels, if the image is empty or lies nowhere, and if vtkGhostType has not one value for each
 * point or cell
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

/**
 * The label image of an array of one component, of any type that VTK has for numbers.
 * @param threads 0 means all cores
 * @throws InputError for values that are no labels, and what else LabelImage::FromScalars() throws
 */
LabelImage<3> ReadLabels(const ChosenArray& input, const LabelSelection& selection,
  unsigned threads, const std::stop_token& stop = {});

/**
 * Adds one component of an array to a series, as its next frame.
 * @throws InputError for a type that VTK has no numbers of, and what FrameSeries::Add() throws
 */
void AddFrame(const ChosenArray& frame, int component, unsigned threads, FrameSeries& series);

/**
 * The volume of a voxel of an input, as the pipeline announces it; 0 if it does not, or if it is not
 * positive and finite.
 */
double FindVoxelVolume(vtkInformation* input);

} // namespace voxplex

#endif
