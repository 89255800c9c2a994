// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimplexMeshWriter.h"

#include "FileError.h"
#include "Meshes/MeshInput.h"
#include "WholeFiles.h"

#include "vtkCommand.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"

#include <optional>

vtkStandardNewMacro(vtkSimplexMeshWriter);

vtkSimplexMeshWriter::vtkSimplexMeshWriter()
  : FileName(nullptr)
  , TemporaryFileName(nullptr)
  , TemporaryCompanionFileName(nullptr)
  , Content(CONTENT_MESH)
  , Slab(-1)
  , Compress(true)
{
  this->SetNumberOfInputPorts(2);
}

vtkSimplexMeshWriter::~vtkSimplexMeshWriter()
{
  this->SetFileName(nullptr);
  this->SetTemporaryFileName(nullptr);
  this->SetTemporaryCompanionFileName(nullptr);
}

void vtkSimplexMeshWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent << "Content: " << (this->Content == CONTENT_MESH ? "mesh" : "interfaces") << "\n"
     << indent << "Slab: " << this->Slab << "\n"
     << indent << "Compress: " << (this->Compress ? "on" : "off") << "\n"
     << indent
     << "TemporaryFileName: " << (this->TemporaryFileName ? this->TemporaryFileName : "(none)")
     << "\n"
     << indent << "TemporaryCompanionFileName: "
     << (this->TemporaryCompanionFileName ? this->TemporaryCompanionFileName : "(none)") << "\n"
     << indent << "ErrorMessage: " << this->ErrorMessage << "\n";
}

int vtkSimplexMeshWriter::FillInputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  if (port == 1)
  {
    information->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  }
  information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkSimplexMeshWriter::Write()
{
  this->ErrorMessage.clear();
  this->SetErrorCode(vtkErrorCode::NoError);
  this->Written = false;
  if (!this->FileName || !*this->FileName)
  {
    this->Fail("no file name is set");
    this->SetErrorCode(vtkErrorCode::NoFileNameError);
    return 0;
  }
  const int port = this->Content == CONTENT_MESH ? 0 : 1;
  if (this->GetNumberOfInputConnections(port) == 0)
  {
    this->Fail(port == 0 ? "there is no mesh to write (input port 0)"
                         : "there are no interfaces to write (input port 1)");
    return 0;
  }
  this->Modified(); // writes even if nothing has changed
  this->UpdateWholeExtent();
  if (!this->Written && this->ErrorMessage.empty())
  {
    this->Fail("what makes the mesh reports an error");
  }
  return this->Written ? 1 : 0;
}

/** Unlike that of the superclass it does not insist on input at port 0. */
int vtkSimplexMeshWriter::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector*)
{
  this->InvokeEvent(vtkCommand::StartEvent);
  this->WriteData();
  this->InvokeEvent(vtkCommand::EndEvent);
  this->WriteTime.Modified();
  return 1;
}

void vtkSimplexMeshWriter::WriteData()
{
  const auto content = static_cast<voxplex::io::Content>(this->Content);
  try
  {
    const voxplex::io::MeshInput input(
      this->GetInput(0), this->GetInput(1), this->Slab, this->Compress);
    input.Check(content, this->FileName);
    const std::string companionName = CompanionOf(this->FileName);
    if (this->TemporaryFileName)
    {
      if (!companionName.empty() && !this->TemporaryCompanionFileName)
      {
        throw voxplex::io::FileError(
          "this format has two files, and TemporaryCompanionFileName is not set");
      }
      input.Write(content, this->FileName, this->TemporaryFileName,
        companionName.empty() ? "" : this->TemporaryCompanionFileName);
    }
    else
    {
      voxplex::io::WholeFiles files;
      files.Add(this->FileName, companionName);
      input.Write(content, this->FileName, files.TemporaryPath(this->FileName),
        companionName.empty() ? "" : files.TemporaryPath(companionName));
      files.Commit();
    }
    this->Written = true;
  }
  catch (const std::bad_alloc&)
  {
    this->Fail("there is not enough memory");
  }
  catch (const voxplex::io::OutputError& error)
  {
    this->Report(error.what());
  }
  catch (const std::exception& error)
  {
    this->Fail(error.what());
  }
}

void vtkSimplexMeshWriter::Fail(const std::string& reason)
{
  this->Report(this->FileName && *this->FileName
      ? "cannot write '" + std::string(this->FileName) + "': " + reason
      : reason);
}

void vtkSimplexMeshWriter::Report(const std::string& error)
{
  this->ErrorMessage = error;
  this->SetErrorCode(vtkErrorCode::UnknownError);
  vtkErrorMacro(<< this->ErrorMessage);
}

bool vtkSimplexMeshWriter::HasFormat(const std::string& fileName, int content, int dimension)
{
  return voxplex::io::HasFormat(voxplex::io::ExtensionOf(fileName),
    static_cast<voxplex::io::Content>(content),
    dimension == 0 ? std::nullopt : std::optional<int>(dimension));
}

std::string vtkSimplexMeshWriter::ListExtensions(int content, int dimension)
{
  return voxplex::io::ListExtensions(static_cast<voxplex::io::Content>(content), dimension);
}

std::string vtkSimplexMeshWriter::CompanionOf(const std::string& fileName)
{
  return voxplex::io::CompanionOf(fileName);
}
