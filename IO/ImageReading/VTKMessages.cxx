// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "VTKMessages.h"

#include "FileError.h"
#include "Text.h"

#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include <cstddef>
#include <string_view>
#include <thread>

namespace voxplex::io
{
namespace
{

std::mutex& OneAtATime()
{
  static std::mutex mutex;
  return mutex;
}

} // namespace

class CollectingWindow : public vtkOutputWindow
{
public:
  static CollectingWindow* New();
  vtkTypeMacro(CollectingWindow, vtkOutputWindow);

  void DisplayText(const char* text) override { this->PassOn(&vtkOutputWindow::DisplayText, text); }
  void DisplayDebugText(const char* text) override
  {
    this->PassOn(&vtkOutputWindow::DisplayDebugText, text);
  }
  void DisplayWarningText(const char* text) override
  {
    this->Collect(this->Warnings, &vtkOutputWindow::DisplayWarningText, text);
  }
  void DisplayErrorText(const char* text) override
  {
    this->Collect(this->Errors, &vtkOutputWindow::DisplayErrorText, text);
  }
  /** VTK's functions without an object, which read arrays, have no errors but these. */
  void DisplayGenericWarningText(const char* text) override
  {
    this->Collect(this->Errors, &vtkOutputWindow::DisplayGenericWarningText, text);
  }

  std::vector<std::string> Errors;
  std::vector<std::string> Warnings;
  vtkSmartPointer<vtkOutputWindow> Others; ///< is told what other threads say

private:
  using Display = void (vtkOutputWindow::*)(const char*);

  void PassOn(Display display, const char* text)
  {
    if (std::this_thread::get_id() != this->Reader)
    {
      (this->Others->*display)(text);
    }
  }

  void Collect(std::vector<std::string>& list, Display display, const char* text)
  {
    constexpr std::size_t enough = 100;
    if (std::this_thread::get_id() == this->Reader && list.size() < enough)
    {
      list.push_back(Shorten(text));
    }
    this->PassOn(display, text);
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

  std::thread::id Reader = std::this_thread::get_id();
};

vtkStandardNewMacro(CollectingWindow);

VTKMessages::VTKMessages()
  : Turn(OneAtATime())
  , AreShown(vtkObject::GetGlobalWarningDisplay())
  , Window(vtkSmartPointer<CollectingWindow>::New())
{
  this->Window->Others = vtkOutputWindow::GetInstance();
  vtkOutputWindow::SetInstance(this->Window);
  vtkObject::SetGlobalWarningDisplay(1); // else VTK says nothing
}

VTKMessages::~VTKMessages()
{
  vtkObject::SetGlobalWarningDisplay(this->AreShown);
  vtkOutputWindow::SetInstance(this->Window->Others);
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
