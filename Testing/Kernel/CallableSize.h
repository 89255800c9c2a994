// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// A size function that is written where it is used.
#ifndef voxplex_CallableSize_h
#define voxplex_CallableSize_h

#include "Image/SizeFunction.h"

#include <functional>
#include <utility>

namespace voxplex
{

class CallableSize final : public SizeFunction<3>
{
public:
  explicit CallableSize(std::function<double(const Point<3>&, std::int64_t)> f)
    : F(std::move(f))
  {
  }
  double Evaluate(const Point<3>& p, std::int64_t label) const override
  {
    return this->F(p, label);
  }

private:
  std::function<double(const Point<3>&, std::int64_t)> F;
};

} // namespace voxplex

#endif
