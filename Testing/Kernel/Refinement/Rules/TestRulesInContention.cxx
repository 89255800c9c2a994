// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The rules step by step, while a second worker owns vertices that they need.
#include "Refinement/Rules/Rules3D.h"
#include "RefinementChecks.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** Two workers on a half-refined ball; a rule of the first meets vertices that the second owns. */
class RulesInContention : public ::testing::Test
{
protected:
  RulesInContention()
    : Ball(5.0)
    , Context(this->Ball, SettingsFor<3>(1.0), Around(this->Ball, 1.0), 1000)
    , One(this->Context, 1)
    , Two(this->Context, 2)
    , Rules(this->Context, this->One)
  {
  }

  /** An element to veto. */
  PoorElementList::Entry Next()
  {
    while (!this->One.Poor.Empty())
    {
      const PoorElementList::Entry e = this->One.Poor.Pop();
      if (this->Context.Mesh.State(e.Id).Generation == e.Generation)
      {
        return e;
      }
    }
    return { None, 0 };
  }

  void PushAll()
  {
    this->One.Kernel.Created.Clear();
    for (const SimplexId s : AliveIn(this->Context.Mesh))
    {
      this->One.Kernel.Created.ReserveMore(1);
      this->One.Kernel.Created.Push(s);
    }
    this->Rules.ScreenCreated();
  }

  RuleOutcome Refine(const PoorElementList::Entry& e)
  {
    EXPECT_EQ(this->Context.Mesh.Lock(this->One.Kernel, e.Id, e.Generation), LockOutcome::Locked);
    return this->Rules.Refine(e.Id);
  }

  const BallDomain Ball;
  RefinementContext<3> Context;
  RefinementWorker<3> One, Two;
  Rules3D Rules;
};

} // namespace

TEST_F(RulesInContention, AContendedElementIsLeftAsItWas)
{
  Triangulation<3>& mesh = this->Context.Mesh;
  this->PushAll();
  int contended = 0;
  int changed = 0;
  for (PoorElementList::Entry e = this->Next(); e.Id != None && changed < 300; e = this->Next())
  {
    // The second worker holds a vertex beyond one of the facets.
    for (const SimplexId n : mesh.GetSimplex(e.Id).N)
    {
      if (n == None || mesh.State(e.Id).Generation != e.Generation)
      {
        continue;
      }
      const std::array<VertexId, 4> own = mesh.GetSimplex(e.Id).V;
      const std::array<VertexId, 4> other = mesh.GetSimplex(n).V;
      const auto apex = std::find_if(other.begin(), other.end(),
        [&](VertexId v) { return std::find(own.begin(), own.end(), v) == own.end(); });
      ASSERT_NE(apex, other.end());
      ASSERT_TRUE(mesh.TryLock(this->Two.Kernel, *apex));
      const std::uint64_t created = this->One.Kernel.NumberOfCreated;
      const std::uint32_t features = this->Context.Features.Size();
      const RuleOutcome outcome = this->Refine(e);
      changed += outcome == RuleOutcome::Changed ? 1 : 0;
      if (outcome == RuleOutcome::Contended)
      {
        ++contended;
        EXPECT_EQ(this->One.Kernel.Winner, 2);
        EXPECT_EQ(this->One.Kernel.NumberOfCreated, created);
        EXPECT_EQ(this->Context.Features.Size(), features);
        EXPECT_TRUE(mesh.IsAlive(e.Id));
        EXPECT_EQ(mesh.State(e.Id).Generation, e.Generation);
      }
      mesh.Unlock(this->One.Kernel);
      mesh.Unlock(this->Two.Kernel);
      ExpectSoundAndUnlocked(mesh);
      break;
    }
    if (mesh.State(e.Id).Generation == e.Generation)
    {
      const RuleOutcome outcome = this->Refine(e);
      EXPECT_NE(outcome, RuleOutcome::Contended) << "nobody holds anything any more";
      changed += outcome == RuleOutcome::Changed ? 1 : 0;
      mesh.Unlock(this->One.Kernel);
    }
  }
  EXPECT_GT(contended, 20);
}

// Removing the one makes others adjacent to the feature vertex, which then have to go, too.
TEST_F(RulesInContention, APutOffRemovalBringsUpOthers)
{
  Triangulation<3>& mesh = this->Context.Mesh;
  const auto insert = [&](const Point<3>& p, VertexKind kind)
  {
    const SimplexId seed = mesh.FindConflict(this->One.Kernel, p, mesh.GetVertex(0).Incident);
    EXPECT_EQ(mesh.Lock(this->One.Kernel, seed, mesh.State(seed).Generation), LockOutcome::Locked);
    EXPECT_EQ(mesh.Insert(this->One.Kernel, p, kind, seed), InsertionOutcome::Inserted);
    return this->One.Kernel.NewVertex;
  };
  // A feature vertex in a cage of free vertices, and more of them behind the first.
  const VertexId z = insert({ 0.01, 0.02, 0.03 }, VertexKind::Feature);
  const VertexId first = insert({ 0.3, 0.0, 0.0 }, VertexKind::Free);
  for (const Point<3>& p : { Point<3>{ -0.3, 0.0, 0.0 }, Point<3>{ 0.0, 0.3, 0.0 },
         Point<3>{ 0.0, -0.3, 0.0 }, Point<3>{ 0.0, 0.0, 0.3 }, Point<3>{ 0.0, 0.0, -0.3 } })
  {
    insert(p, VertexKind::Free);
  }
  const VertexId behind = insert({ 0.5, 0.01, 0.0 }, VertexKind::Free);
  const VertexId far = insert({ 2.0, 0.0, 0.0 }, VertexKind::Free);
  mesh.Unlock(this->One.Kernel);

  this->One.PendingRemovals.push_back({ first, mesh.Position(first), z, 1.0 });
  while (!this->One.PendingRemovals.empty())
  {
    EXPECT_NE(this->Rules.RemovePending(), RuleOutcome::Contended);
    mesh.Unlock(this->One.Kernel);
  }
  EXPECT_FALSE(mesh.GetVertex(first).Alive);
  EXPECT_FALSE(mesh.GetVertex(behind).Alive);
  EXPECT_TRUE(mesh.GetVertex(far).Alive);
  ExpectSoundAndUnlocked(mesh);
}

// A free vertex next to a new feature vertex, with one vertex of its star owned by somebody else.
TEST_F(RulesInContention, AContendedRemovalIsPutOff)
{
  Triangulation<3>& mesh = this->Context.Mesh;
  this->PushAll();
  int putOff = 0;
  for (PoorElementList::Entry e = this->Next(); e.Id != None && putOff < 5; e = this->Next())
  {
    // All free vertices that one could remove, each with all else that is adjacent to it owned.
    std::set<VertexId> cavity;
    {
      const Circumball<3> ball = mesh.GetCircumball(e.Id);
      Point<3> z;
      this->Ball.ClosestSurfacePoint(ball.Center, 0, z);
      for (const SimplexId s : AliveIn(mesh))
      {
        if (mesh.InConflict(this->One.Kernel, s, z))
        {
          cavity.insert(mesh.GetSimplex(s).V.begin(), mesh.GetSimplex(s).V.end());
        }
      }
      cavity.insert(mesh.GetSimplex(e.Id).V.begin(), mesh.GetSimplex(e.Id).V.end());
    }
    for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
    {
      if (mesh.GetVertex(v).Alive && cavity.count(v) == 0)
      {
        ASSERT_TRUE(mesh.TryLock(this->Two.Kernel, v));
      }
    }
    const RuleOutcome outcome = this->Refine(e);
    mesh.Unlock(this->One.Kernel);
    while (!this->One.PendingRemovals.empty())
    {
      ++putOff;
      const PendingRemoval pending = this->One.PendingRemovals.back();
      EXPECT_EQ(outcome, RuleOutcome::Changed);
      EXPECT_EQ(mesh.GetVertex(pending.Vertex).Kind, VertexKind::Free);
      EXPECT_TRUE(mesh.GetVertex(pending.Vertex).Alive);
      EXPECT_EQ(mesh.GetVertex(pending.Feature).Kind, VertexKind::Feature);
      EXPECT_LT(
        Distance(mesh.Position(pending.Vertex), mesh.Position(pending.Feature)), pending.Radius);
      const std::size_t before = this->One.PendingRemovals.size();
      EXPECT_EQ(this->Rules.RemovePending(), RuleOutcome::Contended);
      EXPECT_EQ(this->One.Kernel.Winner, 2);
      EXPECT_EQ(this->One.PendingRemovals.size(), before) << "not to be forgotten";
      mesh.Unlock(this->One.Kernel);
      ExpectSound(mesh);
      mesh.Unlock(this->Two.Kernel);
      EXPECT_EQ(this->Rules.RemovePending(), RuleOutcome::Changed);
      mesh.Unlock(this->One.Kernel);
      EXPECT_FALSE(mesh.GetVertex(pending.Vertex).Alive);
      ExpectSoundAndUnlocked(mesh);
      // What the removal brought up beside the feature vertex goes, too.
      const std::size_t after = this->One.PendingRemovals.size();
      EXPECT_GE(after, before - 1);
      for (std::size_t k = before - 1; k < after; ++k)
      {
        EXPECT_EQ(this->One.PendingRemovals[k].Feature, pending.Feature);
        EXPECT_EQ(mesh.GetVertex(this->One.PendingRemovals[k].Vertex).Kind, VertexKind::Free);
      }
      // Once more: the vertex is gone, so there is nothing to do.
      this->One.PendingRemovals.push_back(pending);
      EXPECT_EQ(this->Rules.RemovePending(), RuleOutcome::Good);
      mesh.Unlock(this->One.Kernel);
      EXPECT_EQ(this->One.PendingRemovals.size(), after);
    }
    mesh.Unlock(this->Two.Kernel);
    if (mesh.State(e.Id).Generation == e.Generation)
    {
      this->Refine(e);
      mesh.Unlock(this->One.Kernel);
      this->One.PendingRemovals.clear();
    }
  }
  EXPECT_GT(putOff, 0) << "the test tests nothing";
}
