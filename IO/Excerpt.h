// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Excerpt.h
 * @brief What a message quotes of a file.
 */
#ifndef voxplex_io_Excerpt_h
#define voxplex_io_Excerpt_h

#include <cstddef>
#include <string>
#include <string_view>

namespace voxplex::io
{

/**
 * A text from a stranger's file, fit to be shown: at most `longest` bytes. Question marks stand for
 * control characters, which terminals obey, and for bytes that are not UTF-8.
 */
std::string Excerpt(std::string_view text, std::size_t longest = 80);

} // namespace voxplex::io

#endif
