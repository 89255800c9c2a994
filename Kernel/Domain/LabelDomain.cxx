// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Domain/ImageDomain.txx"

namespace voxplex
{

template class ImageDomain<3>;
template class ImageDomain<4>;

} // namespace voxplex
