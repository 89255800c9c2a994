// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// A size function that is written where it is used.
#ifndef voxplex_CallableSize_h
#define voxplex_CallableSize_h

#include "Sizing/SizeFunction.h"

#include <functional>
#include <utility>

namespace voxplex
{

template <int D>
class CallableSizeOf final : public SizeFunction<D>
{
public:
  explicit CallableSizeOf(std::function<double(const Point<D>&, std::int64_t)> f)
    : F(std::move(f))
  {
  }
  double Evaluate(const Point<D>& p, std::int64_t label) const override
  {
    return this->F(p, label);
  }

private:
  std::function<double(const Point<D>&, std::int64_t)> F;
};

using CallableSize = CallableSizeOf<3>;

} // namespace voxplex

#endif
