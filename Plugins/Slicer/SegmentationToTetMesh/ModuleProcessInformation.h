// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ModuleProcessInformation.h
 * @brief What a running module and the application that called it tell each other.
 *
 * A structure in the calling application's memory, whose address comes with
 * --processinformationaddress. The layout is that of the Slicer Execution Model
 * (ModuleDescriptionParser/ModuleProcessInformation.h there): plain C, natural alignment.
 */
#ifndef voxplex_slicer_ModuleProcessInformation_h
#define voxplex_slicer_ModuleProcessInformation_h

#include <cstddef>

namespace voxplex::slicer
{

extern "C"
{
  struct ModuleProcessInformation
  {
    unsigned char Abort; ///< the application sets it to something else than 0 to stop the module

    float Progress;                          ///< of the whole module, 0 to 1
    float StageProgress;                     ///< of the present stage, 0 to 1
    char ProgressMessage[1024];              ///< what the present stage does; ends with a 0
    void (*ProgressCallbackFunction)(void*); ///< called after each change of the above; may be null
    void* ProgressCallbackClientData;        ///< its argument; if null, it is not called

    double ElapsedTime; ///< seconds
  };
}

static_assert(offsetof(ModuleProcessInformation, Abort) == 0 &&
    offsetof(ModuleProcessInformation, Progress) == 4 &&
    offsetof(ModuleProcessInformation, StageProgress) == 8 &&
    offsetof(ModuleProcessInformation, ProgressMessage) == 12,
  "the layout that applications expect");
static_assert(sizeof(void*) != 8 ||
    (offsetof(ModuleProcessInformation, ProgressCallbackFunction) == 1040 &&
      offsetof(ModuleProcessInformation, ProgressCallbackClientData) == 1048 &&
      offsetof(ModuleProcessInformation, ElapsedTime) == 1056 &&
      sizeof(ModuleProcessInformation) == 1064),
  "the layout that applications expect");

} // namespace voxplex::slicer

#endif
