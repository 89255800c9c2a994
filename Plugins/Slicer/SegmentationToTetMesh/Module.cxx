// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Module.h"

#include "Arguments.h"
#include "Description.h"
#include "Errors.h"
#include "Job.h"
#include "Logo.h"
#include "Parameters.h"
#include "ProgressReport.h"

#include <voxplexVersion.h>

#include <algorithm>
#include <iostream>
#include <new>

// An array, because applications take the symbol's address for that of the text. It is filled while
// the library is loaded.
char XMLModuleDescription[65536];

namespace voxplex::slicer
{
namespace
{

struct DescriptionFiller
{
  DescriptionFiller()
  {
    const std::string text = DescribeModule();
    const std::size_t length = std::min(text.size(), sizeof(XMLModuleDescription) - 1);
    std::copy_n(text.begin(), length, XMLModuleDescription);
  }
};
const DescriptionFiller Filler;

void PrintLogo()
{
  std::cout << "LOGO\n"
            << LogoWidth << '\n'
            << LogoHeight << '\n'
            << LogoPixelSize << '\n'
            << sizeof(Logo) - 1 << '\n'
            << Logo << std::endl;
}

void PrintValues(const Arguments& arguments)
{
  std::cout << "Command Line Arguments\n";
  for (const Parameter* parameter : AllParameters())
  {
    if (!parameter->IsReturned())
    {
      std::cout << "    " << parameter->Name << ": " << arguments.Text(parameter->Name) << '\n';
    }
  }
  std::cout << std::flush;
}

void Execute(const Arguments& arguments)
{
  switch (arguments.Wanted)
  {
    case Arguments::Request::Help:
      std::cout << HelpText() << std::flush;
      return;
    case Arguments::Request::Version:
      std::cout << ModuleName << "  version: " << VOXPLEX_VERSION << std::endl;
      return;
    case Arguments::Request::Description:
      std::cout << DescribeModule() << std::flush;
      return;
    case Arguments::Request::Logo:
      PrintLogo();
      return;
    case Arguments::Request::Run:
      break;
  }
  if (arguments.Echo)
  {
    PrintValues(arguments);
  }
  RunJob(arguments);
}

int ExecuteSafely(int argc, const char* const* argv)
{
  try
  {
    Execute(Arguments(argc, argv));
    return cli::ExitSuccess;
  }
  catch (const Aborted& end)
  {
    // Slicer takes any other status for an error of a module that it has cancelled itself.
    std::cout << ModuleName << ": " << end.what() << std::endl;
    return cli::ExitSuccess;
  }
  catch (const cli::UsageError& error)
  {
    std::cerr << ModuleName << ": " << error.what() << "\n" << ModuleName << ": see --help\n";
    return cli::ExitUsage;
  }
  catch (const std::bad_alloc&)
  {
    std::cerr << ModuleName << ": out of memory; try a larger --delta or --size\n";
  }
  catch (const std::exception& error)
  {
    std::cerr << ModuleName << ": " << error.what() << '\n';
  }
  return cli::ExitFailure;
}

} // namespace
} // namespace voxplex::slicer

char* GetXMLModuleDescription()
{
  return XMLModuleDescription;
}

unsigned char* GetModuleLogo(int* width, int* height, int* pixelSize, unsigned long* length)
{
  using namespace voxplex::slicer;
  static char text[sizeof(Logo)];
  std::copy_n(Logo, sizeof(Logo), text);
  *width = LogoWidth;
  *height = LogoHeight;
  *pixelSize = LogoPixelSize;
  *length = sizeof(Logo) - 1;
  return reinterpret_cast<unsigned char*>(text);
}

int ModuleEntryPoint(int argc, char* argv[])
{
  return voxplex::slicer::ExecuteSafely(argc, argv);
}
