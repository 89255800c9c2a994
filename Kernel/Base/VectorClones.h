// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file VectorClones.h
 * @brief Compiles a function for several vector units.
 */
#ifndef voxplex_VectorClones_h
#define voxplex_VectorClones_h

/**
 * A function with this attribute is compiled twice, and one version is chosen when the library is
 * loaded. Both give the same result: the vectors differ in width, but the operations are the same (no
 * fused multiply-add). Sanitizers cannot instrument the code that chooses. GCC exports such
 * functions from a shared library unless they are local to a file.
 */
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) &&       \
  !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define VOXPLEX_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define VOXPLEX_VECTOR_CLONES
#endif

#endif
