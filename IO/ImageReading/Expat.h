// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Expat.h
 * @brief Expat's parser of XML, and where it is in a file, which Expat 2.9 has new names for.
 */
#ifndef voxplex_io_Expat_h
#define voxplex_io_Expat_h

#include <vtk_expat.h>

#include <cstdint>

namespace voxplex::io
{

/** The line of the event that is handled now, from 1. */
inline std::uint64_t LineOf(XML_Parser parser)
{
#if 1000 * XML_MAJOR_VERSION + XML_MINOR_VERSION >= 2009
  return XML_GetCurrentLineNumber64(parser);
#else
  return XML_GetCurrentLineNumber(parser);
#endif
}

/** The offset in bytes of the event that is handled now. */
inline std::uint64_t OffsetOf(XML_Parser parser)
{
#if 1000 * XML_MAJOR_VERSION + XML_MINOR_VERSION >= 2009
  return static_cast<std::uint64_t>(XML_GetCurrentByteIndex64(parser));
#else
  return static_cast<std::uint64_t>(XML_GetCurrentByteIndex(parser));
#endif
}

} // namespace voxplex::io

#endif
