// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The answer of the reading process: what is written is read again, and what nobody should write is refused.

#include "ReaderProcess/AnswerMessage.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <iostream>
#include <string>

using namespace voxplex;
using namespace voxplex::io;

namespace
{

constexpr std::uint64_t Memory = 1000;

AnswerMessage MakeAnswer()
{
  AnswerMessage message;
  ScalarImage& image = message.Answer.Image;
  image.Type = ScalarType::Int16;
  image.Dimensions = { 5, 4, 3 };
  image.Frames = 3;
  image.Origin = { 0.1, -1e-17, 1e9 };
  image.Spacing = { 1.0 / 3.0, 0.277, 1e-3 };
  image.Direction = { 0.6, -0.8, 0.1, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0 };
  image.TimeOrigin = -3.0;
  image.TimeSpacing = 5.5;
  image.Times = { -3.0, 1.0, 8.0 };
  message.Offset = 24;
  message.Answer.Labels.Entries[7] = { "Fémur \"left\"", std::array<double, 3>{ 0.1, 0.2, 1.0 } };
  message.Answer.Labels.Entries[1LL << 40] = { "far", std::nullopt };
  message.Answer.Warnings = { "odd\nlines", "not UTF-8: \xff" };
  message.Answer.SpacingGuesses = { "1 is a guess" };
  message.Answer.PlaceGuesses = { "LPS is a guess" };
  message.Answer.Image.HasPlace = false;
  message.Answer.Image.Unit = "micrometres";
  message.Answer.Files = { "voxels.raw" };
  return message;
}

int Failures = 0;

void Expect(bool holds, const char* what)
{
  if (!holds)
  {
    std::cerr << "wrong: " << what << '\n';
    ++Failures;
  }
}

void RoundTrip()
{
  const AnswerMessage before = MakeAnswer();
  const AnswerMessage after = ParseAnswer(ToText(before), Memory);
  const ScalarImage& a = before.Answer.Image;
  const ScalarImage& b = after.Answer.Image;
  Expect(
    a.Type == b.Type && a.Dimensions == b.Dimensions && a.Frames == b.Frames, "type and sizes");
  Expect(a.Origin == b.Origin && a.Spacing == b.Spacing && a.Direction == b.Direction,
    "the same bits of the place");
  Expect(
    a.TimeOrigin == b.TimeOrigin && a.TimeSpacing == b.TimeSpacing && a.Times == b.Times, "times");
  Expect(after.Offset == 24 && after.Error.empty(), "offset");
  const auto& labels = after.Answer.Labels.Entries;
  Expect(labels.size() == 2 && labels.at(7).Name == "Fémur \"left\"" &&
      labels.at(7).Color->at(2) == 1.0 && labels.at(1LL << 40).Name == "far" &&
      !labels.at(1LL << 40).Color,
    "labels");
  Expect(after.Answer.Warnings.size() == 2 && after.Answer.Warnings[0] == "odd\nlines", "warnings");
  Expect(after.Answer.SpacingGuesses == before.Answer.SpacingGuesses &&
      after.Answer.PlaceGuesses == before.Answer.PlaceGuesses && !b.HasSpacing && !b.HasPlace &&
      b.Unit == "micrometres",
    "guesses");
  Expect(after.Answer.Files == std::vector<std::string>{ "voxels.raw" }, "files");

  AnswerMessage refusal;
  refusal.Error = "cannot read 'x\xff': it is damaged";
  Expect(ParseAnswer(ToText(refusal), 0).Error.starts_with("cannot read 'x"), "an error");
}

void Refuses(const char* field, const nlohmann::json& value)
{
  nlohmann::json json = nlohmann::json::parse(ToText(MakeAnswer()));
  json[field] = value;
  try
  {
    ParseAnswer(json.dump(), Memory);
    Expect(false, (std::string("refused: ") + field + " " + value.dump()).c_str());
  }
  catch (const std::exception&)
  {
  }
}

void Refusals()
{
  Refuses("type", -1);
  Refuses("type", 10);
  Refuses("sizes", { 5, 4, 3 });
  Refuses("sizes", { 0, 4, 3, 3 });
  Refuses("sizes", { -5, -4, 3, 3 });
  Refuses("sizes", { 2147483648LL, 1, 1, 1 });
  Refuses("sizes", { 2147483647, 2147483647, 2147483647, 2147483647 });
  Refuses("sizes", { 5, 4, 3, 9 }); // beyond the memory
  Refuses("offset", 641);
  Refuses("offset", 18446744073709551615ULL);
  Refuses("offset", -1);
  Refuses("spacing", { 1, 1, 0 });
  Refuses("spacing", { 1, 1, "1" });
  Refuses("spacing", { 1, 1, nullptr });
  Refuses("origin", { 0, 0, 1e300 });
  Refuses("direction", { 1, 0, 0, 1, 0, 0, 0, 0, 1 });
  Refuses("time", { 0, 0 });
  Refuses("times", { 0, 1 });
  Refuses("times", { 0, 2, 1 });
  Refuses("labels", { { 0, "background" } });
  Refuses("labels", { { 3, "" } });
  Refuses("labels", { { 3 } });
  Refuses("labels", { { 3, "Tibia", { 1, 0 } } });
  Refuses("warnings", 7);
  Refuses("spacing guesses", { 1 });
  Refuses("place guesses", "LPS");
  Refuses("has place", 0);
  Refuses("unit", nullptr);
  Refuses("error", "");
  for (const char* text : { "", "{}", "[]", "{", "nothing", "{\"error\": 3}" })
  {
    try
    {
      ParseAnswer(text, Memory);
      Expect(false, text);
    }
    catch (const std::exception&)
    {
    }
  }
}

} // namespace

int TestAnswerMessage(int, char*[])
{
  RoundTrip();
  Refusals();
  return Failures == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
