// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LibraryMessages.h"

#include "Excerpt.h"

#include <itkOutputWindow.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iostream>
#include <sstream>

#include <fcntl.h>
#include <unistd.h>

namespace voxplex::io
{
namespace
{

/** ITK's window for messages, keeping them instead. */
class CollectingWindow : public itk::OutputWindow
{
public:
  using Self = CollectingWindow;
  using Superclass = itk::OutputWindow;
  using Pointer = itk::SmartPointer<Self>;
  itkFactorylessNewMacro(Self);
  itkTypeMacro(CollectingWindow, OutputWindow);

  void DisplayText(const char* text) override { this->Texts.emplace_back(text); }

  std::vector<std::string> Texts;
};

CollectingWindow* CurrentWindow()
{
  return dynamic_cast<CollectingWindow*>(itk::OutputWindow::GetInstance().GetPointer());
}

std::mutex& TurnMutex()
{
  static std::mutex mutex;
  return mutex;
}

bool ContainsAnyOf(const std::string& line, std::initializer_list<const char*> words)
{
  std::string lower = line;
  std::transform(lower.begin(), lower.end(), lower.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::any_of(words.begin(), words.end(),
    [&lower](const char* word) { return lower.find(word) != std::string::npos; });
}

/** One line of a message: no prefix of ITK's or teem's, single spaces; empty if it only says where.
 */
std::string CleanLine(std::string line)
{
  // "WARNING: In file, line 12" says nothing; "itk::ERROR: Class(0x5581): what" says "what".
  if (line.find(": In ") != std::string::npos && line.find(", line ") != std::string::npos)
  {
    return "";
  }
  const std::size_t address = line.find("(0x");
  const std::size_t colon = address == std::string::npos ? address : line.find("): ", address);
  if (colon != std::string::npos)
  {
    line.erase(0, colon + 3);
  }
  if (line.rfind("[nrrd] ", 0) == 0)
  {
    line.erase(0, 7);
  }
  std::istringstream words(line);
  std::string clean;
  for (std::string word; words >> word;)
  {
    clean += (clean.empty() ? "" : " ") + word;
  }
  return clean;
}

} // namespace

/** Puts the window back that was there when it was made. */
class LibraryMessages::PreviousWindow
{
public:
  PreviousWindow()
    : Window(itk::OutputWindow::GetInstance())
  {
  }
  ~PreviousWindow() { itk::OutputWindow::SetInstance(this->Window); }

private:
  itk::OutputWindow::Pointer Window;
};

LibraryMessages::LibraryMessages()
  : Turn(TurnMutex())
  , Previous(new PreviousWindow)
{
  itk::OutputWindow::SetInstance(CollectingWindow::New());
  std::cerr.flush();
  this->Printed = std::tmpfile();
  this->StandardError = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  if (this->Printed && this->StandardError >= 0)
  {
    dup2(fileno(this->Printed), STDERR_FILENO);
  }
}

LibraryMessages::~LibraryMessages()
{
  std::cerr.flush();
  std::fflush(stderr);
  if (this->StandardError >= 0)
  {
    dup2(this->StandardError, STDERR_FILENO);
    close(this->StandardError);
  }
  if (this->Printed)
  {
    std::fclose(this->Printed);
  }
}

std::vector<std::string> LibraryMessages::Warnings() const
{
  std::vector<std::string> warnings;
  if (const CollectingWindow* window = CurrentWindow())
  {
    for (const std::string& text : window->Texts)
    {
      const std::string warning = Summarize(text);
      if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
      {
        warnings.push_back(warning);
      }
    }
  }
  return warnings;
}

std::string LibraryMessages::DamageReport() const
{
  std::cerr.flush();
  std::fflush(stderr);
  if (!this->Printed)
  {
    return "";
  }
  std::rewind(this->Printed);
  std::array<char, 1024> line;
  while (std::fgets(line.data(), static_cast<int>(line.size()), this->Printed))
  {
    if (ContainsAnyOf(line.data(), { "not read completely", "premature", "truncated", "corrupt" }))
    {
      return CleanLine(line.data());
    }
  }
  return "";
}

std::string LibraryMessages::Summarize(const std::string& message)
{
  std::istringstream lines(message);
  std::string summary;
  bool goesOn = true;
  for (std::string line; goesOn && std::getline(lines, line);)
  {
    line = CleanLine(line);
    if (!line.empty())
    {
      // teem tells a story from the general ("Error reading x.nrrd:") to the particular
      goesOn = line.back() == ':' || !summary.empty();
      summary = line;
    }
  }
  constexpr std::size_t longest = 300;
  return summary.empty() ? "no reason given" : Excerpt(summary, longest);
}

} // namespace voxplex::io
