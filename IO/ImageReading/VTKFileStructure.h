// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VTKFileStructure.h
 * @brief Whether a .vti, .vtu or .vtp file is whole.
 *
 * VTK's reader leaves numbers as they were where no piece has them, and where data end before they should.
 */
#ifndef voxplex_io_VTKFileStructure_h
#define voxplex_io_VTKFileStructure_h

#include "InputFile.h"

#include <vtkAbstractArray.h>

#include <string>
#include <string_view>

class vtkXMLDataElement;

namespace voxplex::io
{

///@{
/** As much of a file as tells whether it is VTK's, and whether that is of the older kind, without XML. */
std::string BeginningOfVTK(const InputFile& file);
bool IsLegacyVTK(const std::string& beginning);
///@}

/** @throws FileError that says what the file holds, if that is not what is wanted */
void CheckKindOfVTK(const std::string& kind, std::string_view wanted);

/**
 * @throws FileError: XML that is not well-formed or holds something else, several pieces, a piece that is not all of
 * the image, arrays that are shorter than they claim, of unknown types, or with numbers that their type does not hold
 */
void CheckStructureOfVTI(const InputFile& file);

/**
 * The same for meshes, whose piece has numbers of points and cells that the file can hold.
 *
 * @param kind what the file must hold: UnstructuredGrid or PolyData
 */
void CheckStructureOfMesh(const InputFile& file, std::string_view kind);

/**
 * One of VTK's readers. It takes texts from the file 1024 bytes at a time, and puts all of them into an array, even if
 * that claims fewer: here there is room for them.
 */
template <typename TReader>
class WithRoomForTexts : public TReader
{
public:
  static WithRoomForTexts* New()
  {
    auto* const reader = new WithRoomForTexts;
    reader->InitializeObjectBase();
    return reader;
  }

protected:
  int ReadArrayValues(vtkXMLDataElement* element, vtkIdType at, vtkAbstractArray* array,
    vtkIdType first, vtkIdType count, typename TReader::FieldType type) override
  {
    constexpr vtkIdType most = 1024;
    if (array->GetDataType() == VTK_STRING)
    {
      array->Resize(array->GetNumberOfTuples() + most);
    }
    return TReader::ReadArrayValues(element, at, array, first, count, type);
  }
};

} // namespace voxplex::io

#endif
