// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FieldTexts.h
 * @brief Texts in the field data of VTK's files.
 *
 * Names of labels and surfaces and the coordinate system are string arrays in memory. meshio reads no file that has
 * one. So files of meshes have the bytes of the texts in their place, see TextsOf() in LabelTable.h. Interfaces of 3D
 * meshes keep strings: meshio does not read their formats at all.
 */
#ifndef voxplex_io_FieldTexts_h
#define voxplex_io_FieldTexts_h

#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

namespace voxplex::io
{

enum class TextForm
{
  Strings, ///< vtkStringArray
  Bytes    ///< vtkUnsignedCharArray
};

/** Gives the texts of field data that are ours these forms, whichever they had. Others' arrays stay as they are. */
void SetTextForms(vtkFieldData* fields, TextForm names, TextForm space);

/** A shallow copy with texts in these forms. */
template <typename TData>
vtkSmartPointer<TData> WithTextForms(TData* data, TextForm names, TextForm space)
{
  auto copy = vtkSmartPointer<TData>::New();
  copy->ShallowCopy(data);
  vtkNew<vtkFieldData> fields;
  fields->ShallowCopy(data->GetFieldData());
  SetTextForms(fields, names, space);
  copy->SetFieldData(fields);
  return copy;
}

} // namespace voxplex::io

#endif
