// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "AnswerMessage.h"

#include "Placement.h"
#include "Text.h"

#include <nlohmann/json.hpp>

#include <stdexcept>

namespace voxplex::io
{
namespace
{

using Json = nlohmann::json;

void Require(bool isSound, const char* what)
{
  if (!isSound)
  {
    throw std::runtime_error(std::string("no sound answer: ") + what);
  }
}

template <typename T, std::size_t N>
std::array<T, N> Numbers(const Json& json)
{
  Require(json.is_array() && json.size() == N, "another number of numbers");
  std::array<T, N> numbers;
  for (std::size_t i = 0; i < N; ++i)
  {
    numbers[i] = json[i].get<T>();
  }
  return numbers;
}

Json LabelsToJson(const LabelTable& table)
{
  Json labels = Json::array();
  for (const auto& [label, entry] : table.Entries)
  {
    Json json = { label, entry.Name };
    if (entry.Color)
    {
      json.push_back(*entry.Color);
    }
    labels.push_back(std::move(json));
  }
  return labels;
}

LabelTable ParseLabels(const Json& json)
{
  LabelTable table;
  for (const Json& label : json)
  {
    const auto value = label.at(0).get<std::int64_t>();
    LabelTable::Entry entry{ label.at(1).get<std::string>(), std::nullopt };
    Require(value > 0 && !entry.Name.empty() && IsUTF8(entry.Name), "a label");
    if (label.size() > 2)
    {
      entry.Color = Numbers<double, 3>(label[2]);
    }
    table.Entries.emplace(value, std::move(entry));
  }
  return table;
}

/** By the functions that readers use, which check everything. */
ScalarImage ParseImage(const Json& json)
{
  ScalarImage image;
  const int type = json.at("type").get<int>();
  Require(type >= 0 && type <= static_cast<int>(ScalarType::Float64), "a type");
  image.Type = static_cast<ScalarType>(type);
  const auto sizes = Numbers<std::int64_t, 4>(json.at("sizes"));
  SetSizes(image, { sizes.begin(), sizes.end() });
  const auto spacing = Numbers<double, 3>(json.at("spacing"));
  const auto direction = Numbers<double, 9>(json.at("direction"));
  std::array<Vector3, 3> steps;
  for (std::size_t i = 0; i < 9; ++i)
  {
    steps[i % 3][i / 3] = direction[i] * spacing[i % 3];
  }
  Place(image, steps, Numbers<double, 3>(json.at("origin")));
  image.Spacing = spacing; // the same bits as there
  image.Direction = direction;
  image.TimeOrigin = json.at("time").at(0).get<double>();
  image.TimeSpacing = json.at("time").at(1).get<double>();
  Require(image.TimeSpacing > 0, "a time step");
  if (const auto times = json.at("times").get<std::vector<double>>(); !times.empty())
  {
    Require(times.size() == static_cast<std::size_t>(image.Frames), "times");
    SetFrameTimes(image, times);
    image.Times = times;
  }
  return image;
}

} // namespace

std::string ToText(const AnswerMessage& message)
{
  const ScalarImage& image = message.Answer.Image;
  const Json json = message.Error.empty() ? Json{ { "type", static_cast<int>(image.Type) },
    { "sizes", { image.Dimensions[0], image.Dimensions[1], image.Dimensions[2], image.Frames } },
    { "origin", image.Origin }, { "spacing", image.Spacing }, { "direction", image.Direction },
    { "time", { image.TimeOrigin, image.TimeSpacing } }, { "times", image.Times },
    { "offset", message.Offset }, { "labels", LabelsToJson(message.Answer.Labels) },
    { "warnings", message.Answer.Warnings }, { "spacing guesses", message.Answer.SpacingGuesses },
    { "place guesses", message.Answer.PlaceGuesses }, { "has place", image.HasPlace },
    { "unit", image.Unit }, { "files", message.Answer.Files } }
                                          : Json{ { "error", message.Error } };
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

AnswerMessage ParseAnswer(std::string_view text, std::uint64_t memory)
{
  const Json json = Json::parse(text);
  AnswerMessage message;
  if (json.contains("error"))
  {
    message.Error = json["error"].get<std::string>();
    Require(!message.Error.empty(), "an error");
    return message;
  }
  ScalarImage& image = message.Answer.Image;
  image = ParseImage(json);
  message.Offset = json.at("offset").get<std::uint64_t>();
  message.Answer.Labels = ParseLabels(json.at("labels"));
  message.Answer.Warnings = json.at("warnings").get<std::vector<std::string>>();
  message.Answer.SpacingGuesses = json.at("spacing guesses").get<std::vector<std::string>>();
  message.Answer.PlaceGuesses = json.at("place guesses").get<std::vector<std::string>>();
  image.HasSpacing = message.Answer.SpacingGuesses.empty();
  image.HasPlace = json.at("has place").get<bool>();
  image.Unit = json.at("unit").get<std::string>();
  message.Answer.Files = json.at("files").get<std::vector<std::string>>();
  const std::uint64_t bytes =
    image.NumberOfVoxels() * static_cast<std::uint64_t>(image.Frames) * SizeOf(image.Type);
  Require(
    message.Offset <= memory && bytes <= memory - message.Offset, "voxels that are not there");
  return message;
}

} // namespace voxplex::io
