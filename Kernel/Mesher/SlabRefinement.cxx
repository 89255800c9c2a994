// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/SlabRefinement.h"

#include "Base/Error.h"
#include "Base/NumberText.h"
#include "Base/Stopwatch.h"
#include "Mesh/SimplexLabels.h"
#include "Refinement/Rules/PlaneLabels.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

namespace voxplex
{

namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();

/** No plane. */
constexpr std::size_t NoPlane = static_cast<std::size_t>(-1);

Point<3> InSpace(const Point<4>& p)
{
  return { p[0], p[1], p[2] };
}

} // namespace

//------------------------------------------------------------------------------------------------
struct SlabRefinement::Slab
{
  Slab(const Domain<4>& whole, double first, double last, const RefinementPlan<4>& plan,
    std::uint64_t interfaceVertices)
    : Part(whole, first, last)
    , Context(Part, plan.Settings, BoxAround<4>(Part, plan.LargestDistance), interfaceVertices)
  {
  }

  double TimeOf(std::size_t end) const
  {
    const Box<4>& box = this->Context.Mesh.GetBox();
    return end == 0 ? box.Min[3] : box.Max[3];
  }

  SlabDomain Part;
  RefinementContext<4> Context;
  std::array<std::size_t, 2> Ends{ NoPlane, NoPlane }; ///< the planes at both ends
  std::array<Plane, 2> Has;                            ///< its vertices there
};

SlabRefinement::~SlabRefinement() = default;

SlabRefinement::SlabRefinement(const RunEnvironment<4>& run, const RefinementPlan<4>& plan)
  : Run(run)
  , Plan(plan)
  , Whole(BoxAround(*run.Prepared.Surfaces, plan.LargestDistance))
  , WholeSizing(*run.Prepared.Surfaces, plan.Settings.Sizing)
{
  const TimePlanes& planes = run.Prepared.Planes;
  const std::size_t inner = planes.Times.size();
  this->Planes.resize(inner + (planes.Periodic ? 1 : 0));
  for (std::size_t k = 0; k <= inner; ++k)
  {
    this->Slabs.push_back(this->MakeSlab(
      k == 0 ? -Infinity : planes.Times[k - 1], k == inner ? Infinity : planes.Times[k]));
    Slab& slab = *this->Slabs.back();
    const double thickness = slab.TimeOf(1) - slab.TimeOf(0);
    if (thickness < ThinnestSlab * run.Statistics.Delta)
    {
      throw InputError("the time planes are too near to each other: a slab of " +
        NumberText(thickness) + " is thinner than delta, which is " +
        NumberText(run.Statistics.Delta) +
        "; ask for fewer planes, a smaller delta, or a larger time scale");
    }
    slab.Ends = { k > 0   ? k - 1
        : planes.Periodic ? inner
                          : NoPlane,
      k < inner           ? k
        : planes.Periodic ? inner
                          : NoPlane };
    slab.Context.IsPlane = { slab.Ends[0] != NoPlane, slab.Ends[1] != NoPlane };
  }
  TimePlaneStatistics& statistics = run.Statistics.Planes;
  statistics.Times = planes.Times;
  statistics.Periodic = planes.Periodic;
}

std::unique_ptr<SlabRefinement::Slab> SlabRefinement::MakeSlab(double first, double last) const
{
  return std::make_unique<Slab>(*this->Run.Prepared.Surfaces, first, last, this->Plan,
    this->Plan.InterfaceVertices / this->Run.Prepared.Planes.NumberOfSlabs() + 1);
}

//------------------------------------------------------------------------------------------------
bool SlabRefinement::Refine(
  const std::vector<FeatureSeed<4>>& seeds, RefinementStart start, RunProgress& progress)
{
  for (unsigned round = 0;; ++round)
  {
    bool goOn = round == 0;
    for (const auto& slab : this->Slabs)
    {
      if (round > 0 && !this->Misses(*slab))
      {
        continue;
      }
      goOn = true;
      for (std::size_t end = 0; end < 2; ++end)
      {
        slab->Context.IsClosed[end] =
          round >= this->Run.Options.Planes.OpenRounds && slab->Ends[end] != NoPlane;
      }
      if (!this->RefineSlab(*slab, round == 0 ? seeds : std::vector<FeatureSeed<4>>(),
            round == 0 ? start : RefinementStart::AtSeeds, progress))
      {
        return false;
      }
    }
    if (!goOn)
    {
      break;
    }
    ++this->Run.Statistics.Planes.Rounds;
  }
  const Stopwatch time;
  this->Unite();
  this->Run.Statistics.Times.Refinement += time.Seconds();
  return !this->Run.Stop.stop_requested();
}

std::vector<FeatureSeed<4>> SlabRefinement::MakeSeeds(
  const Slab& slab, const std::vector<FeatureSeed<4>>& seeds) const
{
  std::vector<FeatureSeed<4>> own;
  for (const FeatureSeed<4>& seed : seeds)
  {
    if (seed.Position[3] >= slab.TimeOf(0) && seed.Position[3] <= slab.TimeOf(1))
    {
      own.push_back(seed);
    }
  }
  for (std::size_t end = 0; end < 2; ++end)
  {
    if (slab.Ends[end] == NoPlane)
    {
      continue;
    }
    for (const auto& [x, kind] : this->Planes[slab.Ends[end]])
    {
      if (!slab.Has[end].contains(x))
      {
        const Point<4> p = { x[0], x[1], x[2], slab.TimeOf(end) };
        own.push_back({ p, slab.Context.Sizing.Spacing(p), true, kind });
      }
    }
  }
  return own;
}

bool SlabRefinement::RefineSlab(Slab& slab, const std::vector<FeatureSeed<4>>& seeds,
  RefinementStart start, RunProgress& progress)
{
  std::uint64_t others = 0;
  for (const auto& other : this->Slabs)
  {
    others += other.get() != &slab ? other->Context.Mesh.VertexIdEnd() : 0;
  }
  if (!RefineContext(this->Run, slab.Context, this->MakeSeeds(slab, seeds), start,
        this->Plan.Vertices, progress, others))
  {
    return false;
  }
  this->TakeVertices(slab);
  return true;
}

/** Shares the vertices that a slab has on planes, and adds them to these. */
void SlabRefinement::TakeVertices(Slab& slab)
{
  Triangulation<4>& mesh = slab.Context.Mesh;
  slab.Has = {};
  for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
  {
    const VertexRecord<4>& vertex = mesh.GetVertex(v);
    for (std::size_t end = 0; end < 2 && vertex.Alive; ++end)
    {
      if (slab.Ends[end] != NoPlane && vertex.Position[3] == slab.TimeOf(end))
      {
        mesh.Share(v);
        slab.Has[end].emplace(InSpace(vertex.Position), vertex.Kind);
      }
    }
  }
  for (std::size_t end = 0; end < 2; ++end)
  {
    if (slab.Ends[end] != NoPlane)
    {
      this->Planes[slab.Ends[end]].insert(slab.Has[end].begin(), slab.Has[end].end());
    }
  }
}

bool SlabRefinement::Misses(const Slab& slab) const
{
  for (std::size_t end = 0; end < 2; ++end)
  {
    // What the slab has is a part of what the plane has.
    if (slab.Ends[end] != NoPlane && slab.Has[end].size() != this->Planes[slab.Ends[end]].size())
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------------------------
void SlabRefinement::Unite()
{
  std::vector<const Triangulation<4>*> parts;
  for (const auto& slab : this->Slabs)
  {
    parts.push_back(&slab->Context.Mesh);
  }
  this->Whole.Join(parts);
  this->FindTwins();
  this->LabelAtPlanes();
  TimePlaneStatistics& statistics = this->Run.Statistics.Planes;
  statistics.Refused = this->Run.Statistics.Rules.RefusedOnClosedEnd;
  statistics.Vertices = 0;
  for (const Plane& plane : this->Planes)
  {
    statistics.Vertices += plane.size();
  }
}

void SlabRefinement::FindTwins()
{
  this->Pairs.clear();
  const TimePlanes& planes = this->Run.Prepared.Planes;
  if (!planes.Periodic)
  {
    return;
  }
  std::map<Point<3>, VertexId> first;
  for (VertexId v = 0; v < this->Whole.VertexIdEnd(); ++v)
  {
    if (this->Whole.GetVertex(v).Alive && this->Whole.Position(v)[3] == planes.First)
    {
      first.emplace(InSpace(this->Whole.Position(v)), v);
    }
  }
  for (VertexId v = 0; v < this->Whole.VertexIdEnd(); ++v)
  {
    if (this->Whole.GetVertex(v).Alive && this->Whole.Position(v)[3] == planes.Last)
    {
      this->Pairs.push_back({ first.at(InSpace(this->Whole.Position(v))), v });
    }
  }
  std::sort(this->Pairs.begin(), this->Pairs.end());
}

//------------------------------------------------------------------------------------------------
/** Labels the pentatopes with a facet on a plane. */
void SlabRefinement::LabelAtPlanes()
{
  const TimePlanes& planes = this->Run.Prepared.Planes;
  std::vector<VertexId> twinOf(this->Whole.VertexIdEnd(), None);
  for (const auto& [first, last] : this->Pairs)
  {
    twinOf[last] = first;
  }
  TimePlaneStatistics& statistics = this->Run.Statistics.Planes;
  statistics.Facets = 0;
  statistics.Relabelled = 0;
  for (SimplexId s = 0; s < this->Whole.SimplexIdEnd(); ++s)
  {
    if (!this->Whole.IsAlive(s))
    {
      continue;
    }
    auto facet =
      FacetOnPlane(this->Whole, s, [&](double time) { return planes.HaveFacetsAt(time); });
    if (!facet)
    {
      continue;
    }
    for (VertexId& vertex : *facet)
    {
      vertex = twinOf[vertex] == None ? vertex : twinOf[vertex];
    }
    const LabelId label = this->Run.Prepared.Surfaces->Label(CentreOnPlane(this->Whole, *facet));
    const LabelId atCentre = LabelAtCentre(this->Whole, *this->Run.Prepared.Surfaces, s);
    statistics.Facets += label != 0 ? 1 : 0;
    statistics.Relabelled += label != atCentre ? 1 : 0;
    SimplexState& state = this->Whole.State(s);
    state.Label = label;
    state.Labelled = true;
    state.NearSurface = state.NearSurface || label != atCentre;
  }
  statistics.Facets /= 2; // each was seen from both sides
}

} // namespace voxplex
