// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FileError.h
 * @brief What reading and writing files throws.
 */
#ifndef voxplex_io_FileError_h
#define voxplex_io_FileError_h

#include "Refuse.h"

namespace voxplex::io
{

/** A file cannot be read or written; the message has one line, for the user. */
using FileError = InputError;
using voxplex::Refuse;
using voxplex::RefuseIf;

} // namespace voxplex::io

#endif
