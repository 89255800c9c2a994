/* SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
 * SPDX-License-Identifier: BSD-3-Clause
 *
 * Stands for libcurl.so.4 in the wheel. Debian's libhdf5 is linked with that library, for files at Amazon's S3, and with it
 * come twenty others, such as GnuTLS and Kerberos. With this one, such a file cannot be opened.
 * Functions take any arguments and look at none.
 */
enum
{
  FailedInit = 2 /* CURLE_FAILED_INIT of curl.h */
};

int curl_global_init()
{
  return FailedInit;
}
void curl_global_cleanup() {}
void* curl_easy_init()
{
  return 0;
}
int curl_easy_setopt()
{
  return FailedInit;
}
int curl_easy_perform()
{
  return FailedInit;
}
void curl_easy_cleanup() {}
void* curl_slist_append()
{
  return 0;
}
void curl_slist_free_all() {}
