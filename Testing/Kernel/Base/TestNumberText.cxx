// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/NumberText.h"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <string>

using namespace voxplex;

namespace
{

/** Numbers with a decimal comma and a point between thousands. */
class CommaNumbers : public std::numpunct<char>
{
protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/** Makes a locale the global one until it goes out of scope. */
class GlobalLocale
{
public:
  explicit GlobalLocale(const std::locale& locale)
    : Before(std::locale::global(locale))
  {
  }
  ~GlobalLocale() { std::locale::global(this->Before); }
  GlobalLocale(const GlobalLocale&) = delete;
  GlobalLocale& operator=(const GlobalLocale&) = delete;

private:
  std::locale Before;
};

} // namespace

//------------------------------------------------------------------------------------------------
TEST(NumberText, HasSixSignificantDigitsUnlessAskedForOthers)
{
  EXPECT_EQ(NumberText(3.14159265358979), "3.14159");
  EXPECT_EQ(NumberText(3.14159265358979, 1), "3");
  EXPECT_EQ(NumberText(3.14159265358979, 3), "3.14");
  EXPECT_EQ(NumberText(3.14159265358979, 10), "3.141592654");
  EXPECT_EQ(NumberText(-2.0 / 3.0), "-0.666667");
  EXPECT_EQ(NumberText(0.1, 17), "0.10000000000000001");
}

TEST(NumberText, LeavesOutZerosAtTheEnd)
{
  EXPECT_EQ(NumberText(0.0), "0");
  EXPECT_EQ(NumberText(1.0), "1");
  EXPECT_EQ(NumberText(-42.0), "-42");
  EXPECT_EQ(NumberText(999999.0), "999999");
  EXPECT_EQ(NumberText(1.50), "1.5");
  EXPECT_EQ(NumberText(0.99999999), "1");
}

TEST(NumberText, HasAnExponentIfTheNumberIsLargeOrSmall)
{
  EXPECT_EQ(NumberText(1e5), "100000");
  EXPECT_EQ(NumberText(1e6), "1e+06");
  EXPECT_EQ(NumberText(1234567.0), "1.23457e+06");
  EXPECT_EQ(NumberText(1234567.0, 7), "1234567");
  EXPECT_EQ(NumberText(0.0001), "0.0001");
  EXPECT_EQ(NumberText(0.00001), "1e-05");
}

/** The longest texts fit. */
TEST(NumberText, CoversTheWholeRange)
{
  EXPECT_EQ(NumberText(std::numeric_limits<double>::max()), "1.79769e+308");
  EXPECT_EQ(NumberText(std::numeric_limits<double>::denorm_min()), "4.94066e-324");
  EXPECT_EQ(NumberText(-std::numeric_limits<double>::max(), 17), "-1.7976931348623157e+308");
  EXPECT_EQ(NumberText(-0.00012345678901234567, 17), "-0.00012345678901234567");
}

TEST(NumberText, NamesWhatIsNoFiniteNumber)
{
  EXPECT_EQ(NumberText(HUGE_VAL), "inf");
  EXPECT_EQ(NumberText(-HUGE_VAL), "-inf");
  EXPECT_EQ(NumberText(std::nan("")), "nan");
  EXPECT_EQ(NumberText(-0.0), "-0");
}

TEST(NumberText, IsTheSameInEveryLocale)
{
  const GlobalLocale guard(std::locale(std::locale(), new CommaNumbers));
  std::ostringstream stream;
  stream << 12345.5;
  ASSERT_EQ(stream.str(), "12.345,5"); // the locale is in force
  EXPECT_EQ(NumberText(12345.5), "12345.5");
}
