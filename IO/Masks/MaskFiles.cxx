// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Masks/MaskFiles.h"

#include "FileError.h"
#include "ImageReading/FilesOfFolder.h"
#include "MasksOnGrid.h"
#include "Text.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>
#include <optional>
#include <string_view>

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

// --- Names -------------------------------------------------------------------------------------------

/** Of files in a folder that are masks: those of volumes, the longer first. */
constexpr std::array<std::string_view, 16> Extensions{ ".seg.nrrd", ".nii.gz", ".hdr.gz",
  ".gipl.gz", ".nii", ".nrrd", ".nhdr", ".hdr", ".mha", ".mhd", ".gipl", ".mgh", ".mgz", ".vti",
  ".vtk", ".mrc" };
/** What these files have their voxels in. */
constexpr std::array<std::string_view, 5> DataExtensions{ ".img", ".img.gz", ".raw", ".raw.gz",
  ".zraw" };

template <std::size_t N>
std::string_view ExtensionOf(const std::string& name, const std::array<std::string_view, N>& list)
{
  const std::string lower = LowerCase(name);
  const auto found = std::find_if(list.begin(), list.end(),
    [&lower](std::string_view end) { return lower.size() > end.size() && lower.ends_with(end); });
  return found == list.end() ? std::string_view() : *found;
}

std::string NameOf(const std::string& path)
{
  const fs::path file = fs::path(path).filename();
  const std::string name = file.string();
  const std::size_t length = ExtensionOf(name, Extensions).size();
  return length > 0 ? name.substr(0, name.size() - length) : file.stem().string();
}

/** The masks of a folder; none if a file is DICOM, or this is no folder. */
std::vector<std::string> ListMasks(const std::string& folder, std::vector<std::string>& warnings)
{
  std::vector<std::string> masks;
  std::vector<std::string> others;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
  {
    std::error_code failed;
    const std::string name = entry.path().filename().string();
    if (name.starts_with('.') || !entry.is_regular_file(failed))
    {
      continue;
    }
    if (!ExtensionOf(name, Extensions).empty())
    {
      masks.push_back(entry.path().string());
    }
    else if (IsDICOMFile(entry.path().string()))
    {
      return {};
    }
    else if (ExtensionOf(name, DataExtensions).empty())
    {
      others.push_back(Excerpt(name));
    }
  }
  std::string text;
  for (const std::string& name : SortByNumbers(others))
  {
    text += (text.empty() ? "" : ", ") + name;
  }
  if (!masks.empty() && !text.empty())
  {
    warnings.push_back(
      folder + ": left out what is no image, or a mask only if it is named: " + text);
  }
  return SortByNumbers(masks);
}

// --- Reading -----------------------------------------------------------------------------------------

/** Warnings that many files have in common are said once. */
class FileWarnings
{
public:
  void Add(const std::string& path, const std::vector<std::string>& warnings)
  {
    for (const std::string& warning : warnings)
    {
      const std::string text =
        warning.starts_with(path + ": ") ? warning.substr(path.size() + 2) : warning;
      const auto same = std::find_if(this->All.begin(), this->All.end(),
        [&text](const Said& said) { return said.Text == text; });
      if (same == this->All.end())
      {
        this->All.push_back({ path, text, 0 });
      }
      else
      {
        ++same->Others;
      }
    }
  }

  std::vector<std::string> Lines() const
  {
    std::vector<std::string> lines;
    for (const Said& said : this->All)
    {
      lines.push_back(said.Path +
        (said.Others > 0 ? " and " + std::to_string(said.Others) + " more" : "") + ": " +
        said.Text);
    }
    return lines;
  }

private:
  struct Said
  {
    std::string Path;
    std::string Text;
    int Others;
  };
  std::vector<Said> All;
};

/** One of so many. */
ImageAnswer ReadOne(
  ImageRequest request, const std::string& path, std::size_t number = 0, std::size_t count = 1)
{
  request.Path = path;
  if (request.Proceed)
  {
    request.Proceed = [all = request.Proceed, number, count](double part)
    { return all((static_cast<double>(number) + part) / static_cast<double>(count)); };
  }
  return ReadImage(request);
}

/** Nothing if their grids differ, and have not been offered. */
std::optional<ImageAnswer> ReadMasks(const std::vector<std::string>& paths,
  const ImageRequest& request, bool resample, bool isPlaced, bool offer)
{
  const auto shown = [](const std::string& path) { return "'" + path + "'"; };
  const std::size_t count = paths.size() * (offer ? 2 : 1);
  std::size_t number = 0;
  MasksOnGrid masks(resample, request.MaskThreshold);
  for (std::size_t i = 0; offer && i < paths.size(); ++i)
  {
    masks.OfferGrid(ReadOne(request, paths[i], number++, count).Image, shown(paths[i]));
  }
  if (offer && isPlaced)
  {
    masks.CheckOneOrigin();
  }
  FileWarnings warnings;
  FileWarnings guesses;
  std::vector<std::string> files = paths;
  for (const std::string& path : paths)
  {
    ImageAnswer answer = ReadOne(request, path, number++, count);
    warnings.Add(path, answer.Warnings);
    if (!masks.TakePlace(answer.Image, shown(path)))
    {
      warnings.Add(path, answer.PlaceGuesses);
      guesses.Add(path, answer.SpacingGuesses);
    }
    files.insert(files.end(), answer.Files.begin(), answer.Files.end());
    if (!masks.Add({ NameOf(path), std::nullopt }, std::move(answer.Image), shown(path)))
    {
      return std::nullopt;
    }
  }
  ImageAnswer all;
  all.Warnings = warnings.Lines();
  all.Image = masks.Finish(request.Rule, all.Warnings);
  all.Labels = masks.GetLabels();
  all.SpacingGuesses = guesses.Lines();
  all.Files = std::move(files);
  return all;
}

} // namespace

ImageAnswer ReadImageOrMasks(
  const std::vector<std::string>& paths, const ImageRequest& request, bool resample, bool isPlaced)
{
  std::vector<std::string> warnings;
  std::vector<std::string> masks = paths;
  if (paths.size() == 1)
  {
    masks =
      request.Series.empty() ? ListMasks(paths.front(), warnings) : std::vector<std::string>();
  }
  if (masks.empty())
  {
    return ReadOne(request, paths.front());
  }
  try
  {
    std::optional<ImageAnswer> answer = ReadMasks(masks, request, resample, isPlaced, false);
    if (!answer)
    {
      answer = ReadMasks(masks, request, resample, isPlaced, true);
    }
    answer->Warnings.insert(answer->Warnings.begin(), warnings.begin(), warnings.end());
    return std::move(*answer);
  }
  catch (const std::bad_alloc&)
  {
    Refuse("cannot read '", paths.front(), "' and the other masks: they do not fit into memory");
  }
}

} // namespace voxplex::io
