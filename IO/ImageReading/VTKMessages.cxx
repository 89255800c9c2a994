// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VTKMessages.h"

#include "FileError.h"
#include "Text.h"

#include <cstddef>
#include <string_view>
#include <vtkObjectFactory.h>

namespace voxplex::io
{

class CollectingWindow : public vtkOutputWindow
{
public:
  static CollectingWindow* New();
  vtkTypeMacro(CollectingWindow, vtkOutputWindow);

  void DisplayText(const char*) override {}
  void DisplayDebugText(const char*) override {}
  void DisplayWarningText(const char* text) override { Collect(this->Warnings, text); }
  void DisplayErrorText(const char* text) override { Collect(this->Errors, text); }
  /** VTK's functions without an object, which read arrays, have no errors but these. */
  void DisplayGenericWarningText(const char* text) override { Collect(this->Errors, text); }

  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;

private:
  static void Collect(std::vector<std::string>& list, const char* text)
  {
    constexpr std::size_t enough = 100;
    if (list.size() < enough)
    {
      list.push_back(Shorten(text));
    }
  }

  /** Without the source file, its line, the class and the address of the object. */
  static std::string Shorten(std::string_view text)
  {
    const std::size_t line = text.find('\n');
    text = line == text.npos ? text : text.substr(line + 1);
    const std::size_t object = text.find("): ");
    text = object == text.npos ? text : text.substr(object + 3);
    return Excerpt(text.substr(0, text.find('\n')), 200);
  }
};

vtkStandardNewMacro(CollectingWindow);

VTKMessages::VTKMessages()
  : AreShown(vtkObject::GetGlobalWarningDisplay())
  , Before(vtkOutputWindow::GetInstance())
  , Window(vtkSmartPointer<CollectingWindow>::New())
{
  vtkOutputWindow::SetInstance(this->Window);
  vtkObject::SetGlobalWarningDisplay(1); // else VTK says nothing
}

VTKMessages::~VTKMessages()
{
  vtkObject::SetGlobalWarningDisplay(this->AreShown);
  vtkOutputWindow::SetInstance(this->Before);
}

void VTKMessages::CheckErrors() const
{
  if (!this->Window->Errors.empty())
  {
    Refuse("VTK does not read it: ", this->Window->Errors.front());
  }
}

const std::vector<std::string>& VTKMessages::Warnings() const
{
  return this->Window->Warnings;
}

} // namespace voxplex::io
