/* SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Stands for libjbig.so.0 in the wheel. Debian's libtiff is linked with that library, which is under the GPL and cannot
 * be in a wheel. With this one, every TIFF page with JBIG's compression (fax machines have it) is an error.
 * Functions take any arguments and look at none.
 */
enum
{
  Aborted = 4 << 4 /* JBG_EABORT of jbig.h */
};

void jbg_dec_init() {}
int jbg_dec_in()
{
  return Aborted;
}
unsigned char* jbg_dec_getimage()
{
  return 0;
}
unsigned long jbg_dec_getsize()
{
  return 0;
}
void jbg_dec_free() {}
void jbg_enc_init() {}
void jbg_enc_out() {}
void jbg_enc_free() {}
int jbg_newlen()
{
  return Aborted;
}
const char* jbg_strerror()
{
  return "JBIG's compression is not supported";
}
