// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexMeshRun.h
 * @brief What the meshing filters of both dimensions share of an execution.
 */
#ifndef voxplex_SimplexMeshRun_h
#define voxplex_SimplexMeshRun_h

#include "Base/Error.h"
#include "Base/Stopwatch.h"
#include "Mesher/ImageMesher.h"
#include "Private/ChosenArray.h"
#include "Private/ElementSizes.h"
#include "Private/MeshingMessages.h"

#include "vtkImageData.h"
#include "vtkImageToSimplexMeshFilter.h"
#include "vtkInformationVector.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

struct vtkImageToSimplexMeshFilter::Internals
{
  std::map<std::int64_t, double> LabelSizes;
  std::map<std::pair<std::int64_t, std::int64_t>, double>
    InterfaceSizes; ///< the larger label first
  std::set<std::int64_t> Labels;
  std::set<std::int64_t> ExcludedLabels;
  SizeFunctionType SizeFunction;
  vtkNew<vtkMeshingStatistics> Statistics;
  std::vector<std::string> Warnings; ///< of the last execution

  voxplex::LabelSelection Selection() const
  {
    return { { this->Labels.begin(), this->Labels.end() },
      { this->ExcludedLabels.begin(), this->ExcludedLabels.end() } };
  }
};

/**
 * One execution: make it, adjust Options and Sizes, read the image, Mesh(), write the outputs.
 */
template <int D>
class vtkImageToSimplexMeshFilter::Run
{
public:
  /**
   * Options and sizes as the filter's common parameters and its input port 1 say.
   * @param frame how the images lie
   * @throws voxplex::InputError if the image of element sizes is unsuitable
   */
  Run(vtkImageToSimplexMeshFilter* filter, vtkInformationVector** inputVector,
    const voxplex::FrameOf<D>& frame)
    : Sizes(std::make_shared<voxplex::ElementSizes<D>>())
    , Filter(filter)
  {
    this->Sizes->Frame = frame;
    this->Sizes->Uniform = filter->ElementSize;
    this->Sizes->PerLabel = filter->Private->LabelSizes;
    this->Sizes->Function = filter->Private->SizeFunction;
    if (vtkImageData* image = vtkImageData::GetData(inputVector[1]))
    {
      int association = 0;
      vtkAbstractArray* values =
        filter->GetInputAbstractArrayToProcess(1, inputVector, association);
      const voxplex::ChosenArray chosen = voxplex::ChooseScalars(image, values, association,
        voxplex::ImageContent::GreyValues, "image of element sizes", "");
      if constexpr (D == 3)
      {
        voxplex::CheckOverlap(chosen.Frame, frame);
      }
      else
      {
        voxplex::CheckOverlap(chosen.Frame, frame.Space);
      }
      this->Sizes->Image.emplace(chosen.Frame, chosen.Array);
    }
    const bool isDeltaIdle = filter->DeltaIsSuggestion && filter->NumberOfElements > 0;
    this->Options.Sampling.Delta = isDeltaIdle ? 0.0 : filter->Delta;
    this->Options.Sampling.Elements = static_cast<std::uint64_t>(filter->NumberOfElements);
    this->Options.Sampling.Gradation = filter->Gradation;
    this->Options.Sampling.Grading = { static_cast<voxplex::GradingMode>(filter->Grading),
      filter->FeatureRatio, filter->LargestFeature };
    for (const auto& [interface, size] : filter->Private->InterfaceSizes)
    {
      this->Options.Sampling.InterfaceSizes.push_back({ interface.first, interface.second, size });
    }
    this->Options.Shape.RadiusEdgeRatio = filter->RadiusEdgeRatio;
    this->Options.Interfaces.Rounds = static_cast<unsigned>(filter->InterfaceRounds);
    this->Options.Interfaces.Manifold = filter->Manifold;
    this->Options.Interfaces.Fit = filter->FitInterfaces;
    this->Options.Optimisation.Run = filter->Optimise;
    this->Options.Components.Smallest = filter->SmallestComponent;
    this->Options.Components.Exact = filter->ExactComponents;
    this->Options.SmoothingSigma = filter->SmoothingSigma;
    this->Options.Team.Threads = filter->GetThreads();
    this->Options.Team.Contention =
      static_cast<voxplex::ContentionPolicy>(filter->ContentionManager);
    this->Options.Team.Balance = static_cast<voxplex::BalancePolicy>(filter->LoadBalancer);
    this->Options.Team.Pin = filter->PinThreads;
    this->Options.Team.Reproducible = filter->Reproducible;
    this->Options.Limits.Force = filter->Force;
    this->Options.Limits.Memory = filter->MemoryLimit;
    this->Options.MeasureQuality = filter->ComputeQuality;
  }

  voxplex::MeshingOptions<D> Options;
  std::shared_ptr<voxplex::ElementSizes<D>> Sizes;
  /** Progress when the kernel starts. */
  double ProgressBefore = 0.0;

  voxplex::LabelSelection SelectedLabels() const { return this->Filter->Private->Selection(); }

  /**
   * The isosurface that the filter meshes.
   * @throws voxplex::InputError if labels are chosen, which grey values do not have
   */
  voxplex::Isosurface ChosenIsosurface() const
  {
    const vtkImageToSimplexMeshFilter* const filter = this->Filter;
    using Class = vtkImageToSimplexMeshFilter;
    static_assert(Class::INSIDE_ABOVE == static_cast<int>(voxplex::IsosurfaceSide::Above) &&
      Class::INSIDE_BELOW == static_cast<int>(voxplex::IsosurfaceSide::Below));
    const voxplex::LabelSelection selection = this->SelectedLabels();
    if (!selection.Only.empty() || !selection.But.empty())
    {
      throw voxplex::InputError("{labels} and ExcludeLabel() choose among the labels of a label "
                                "image, but InputMode is isosurface; remove the labels.");
    }
    return { filter->Isovalue, static_cast<voxplex::IsosurfaceSide>(filter->Inside),
      filter->InsideLabel, filter->IsosurfaceSmoothingSigma };
  }

  /**
   * Calls the kernel and fills the statistics. The time since the run was made is counted as reading
   * the image.
   * @param image a LabelImage or an IsosurfaceImage
   * @return false if stopped; the mesh is then empty
   * @throws voxplex::Error, std::bad_alloc, what the size function throws
   */
  template <typename Image>
  bool Mesh(Image image, voxplex::SimplexMesh<D>& mesh)
  {
    if constexpr (std::is_same_v<Image, voxplex::IsosurfaceImage<D>>)
    {
      this->CheckLabels(image.Labels());
    }
    else
    {
      this->CheckLabels(image);
    }
    if (this->Sizes->Any())
    {
      this->Options.Sampling.Size = this->Sizes;
    }
    const double readingTime = this->Watch.Seconds();

    voxplex::ImageMesher<D> mesher(this->Options);
    mesher.Progress = [this](double fraction)
    {
      this->Filter->UpdateProgress(
        this->ProgressBefore + (KernelProgress - this->ProgressBefore) * fraction);
      return !this->Sizes->Failed() && !this->Filter->StopRequested();
    };
    const voxplex::MeshingOutcome outcome = mesher.Run(std::move(image), mesh);
    this->Sizes->Rethrow();
    if (outcome == voxplex::MeshingOutcome::Cancelled || this->Filter->StopRequested())
    {
      this->Filter->Aborted = true;
      return false;
    }

    this->Statistics() = mesher.Statistics();
    voxplex::CheckNotEmpty(this->Statistics());
    this->Statistics().Times.LabelField += readingTime;
    this->WarnOfSizes(mesh);
    return true;
  }

  voxplex::MeshingStatistics& Statistics() { return this->Filter->Private->Statistics->Edit(); }

private:
  /** If the image of sizes does not reach as far as the mesh. */
  void WarnOfSizes(const voxplex::SimplexMesh<D>& mesh)
  {
    const voxplex::ElementSizes<D>& sizes = *this->Sizes;
    const auto outside = std::count_if(mesh.Points.begin(), mesh.Points.end(),
      [&sizes](const voxplex::Point<D>& p)
      {
        const voxplex::Point<D> x = sizes.Frame.ToWorld(p);
        return sizes.Image && !sizes.Image->Covers({ x[0], x[1], x[2] });
      });
    if (outside > 0)
    {
      this->Filter->Warn("The image of sizes ({size-image}) does not cover " +
        std::to_string(outside) + " of " + std::to_string(mesh.Points.size()) +
        " vertices of the mesh; there the nearest of its sizes holds.");
    }
  }

  /** Of sizes, against those of the image. */
  void CheckLabels(const voxplex::LabelImage<D>& image) const
  {
    const auto labels = image.Values().subspan(1); // without background
    const Internals& filter = *this->Filter->Private;
    const bool selected = !filter.Labels.empty() || !filter.ExcludedLabels.empty();
    for (const auto& [label, size] : filter.LabelSizes)
    {
      voxplex::CheckSizedLabel(label, "{label-size}", selected, labels);
    }
    for (const auto& [interface, size] : filter.InterfaceSizes)
    {
      for (const std::int64_t label : { interface.first, interface.second })
      {
        if (label > 0) // background and ANY_LABEL are always there
        {
          voxplex::CheckSizedLabel(label, "{interface-size}", selected, labels);
        }
      }
    }
  }

  /** The fraction of the progress at the kernel's end; the rest is the copy into VTK data. */
  static constexpr double KernelProgress = 0.97;

  vtkImageToSimplexMeshFilter* Filter;
  voxplex::Stopwatch Watch;
};

#endif
