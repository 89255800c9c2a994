// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VTKMessages.h
 * @brief What VTK's readers say about a file.
 */
#ifndef voxplex_io_VTKMessages_h
#define voxplex_io_VTKMessages_h

#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

namespace voxplex::io
{

class CollectingWindow;

/** Collects the messages of all threads for as long as it lives: for programs in which nothing else uses VTK meanwhile. */
class VTKMessages
{
public:
  VTKMessages();
  ~VTKMessages();
  VTKMessages(const VTKMessages&) = delete;
  VTKMessages& operator=(const VTKMessages&) = delete;

  /** @throws FileError with the first error, if there is one */
  void CheckErrors() const;

  const std::vector<std::string>& Warnings() const;

private:
  int AreShown;
  vtkSmartPointer<vtkOutputWindow> Before;
  vtkSmartPointer<CollectingWindow> Window;
};

} // namespace voxplex::io

#endif
