// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file XMLText.h
 * @brief Text for XML files.
 */
#ifndef voxplex_io_XMLText_h
#define voxplex_io_XMLText_h

#include <string>
#include <string_view>

namespace voxplex::io
{

/** For text and for values between double quotation marks: `&amp;`, `&lt;`, `&gt;`, `&quot;`. */
std::string EscapeForXML(std::string_view text);

} // namespace voxplex::io

#endif
