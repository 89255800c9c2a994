// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ScalarTypes.h
 * @brief The scalar types that an image may have.
 */
#ifndef voxplex_ScalarTypes_h
#define voxplex_ScalarTypes_h

/** Expands to `statement(T);` for each scalar type T, for explicit instantiations of templates. */
#define VOXPLEX_FOR_EACH_SCALAR_TYPE(statement)                                                    \
  statement(char);                                                                                 \
  statement(signed char);                                                                          \
  statement(unsigned char);                                                                        \
  statement(short);                                                                                \
  statement(unsigned short);                                                                       \
  statement(int);                                                                                  \
  statement(unsigned int);                                                                         \
  statement(long);                                                                                 \
  statement(unsigned long);                                                                        \
  statement(long long);                                                                            \
  statement(unsigned long long);                                                                   \
  statement(float);                                                                                \
  statement(double)

#endif
