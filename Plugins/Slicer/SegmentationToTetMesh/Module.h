// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Module.h
 * @brief The symbols that applications look for in a module's library, as the Slicer Execution Model
 * names them.
 */
#ifndef voxplex_slicer_Module_h
#define voxplex_slicer_Module_h

#if defined(_WIN32)
#define VOXPLEX_MODULE_EXPORT __declspec(dllexport)
#else
#define VOXPLEX_MODULE_EXPORT __attribute__((visibility("default")))
#endif

extern "C"
{
  /** The description in XML; ends with a 0. */
  extern VOXPLEX_MODULE_EXPORT char XMLModuleDescription[];
  VOXPLEX_MODULE_EXPORT char* GetXMLModuleDescription();

  /**
   * The logo: rows from the top, pixelSize bytes a pixel, compressed by zlib and encoded in base 64.
   *
   * @param length of the encoded text, which ends with a 0
   */
  VOXPLEX_MODULE_EXPORT unsigned char* GetModuleLogo(
    int* width, int* height, int* pixelSize, unsigned long* length);

  /**
   * Runs the module; the arguments are those of a command line. It may be called several times.
   *
   * @return 0 done or cancelled, 1 failed, 2 wrong arguments; the reason is on std::cerr
   */
  VOXPLEX_MODULE_EXPORT int ModuleEntryPoint(int argc, char* argv[]);
}

#endif
