// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Triangulation.h
 * @brief The Delaunay triangulation of a box under insertion and removal of points.
 */
#ifndef voxplex_Triangulation_h
#define voxplex_Triangulation_h

#include "Delaunay/RidgeTable.h"
#include "Delaunay/Stack.h"
#include "Delaunay/Stores.h"
#include "Geometry/Box.h"
#include "Geometry/Predicates.h"
#include "Parallel/LoopSharing.h"

#include <atomic>
#include <cassert>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace voxplex
{

enum class InsertionOutcome
{
  Inserted,
  NoConflict, ///< the point does not conflict with the simplex that was given
  Duplicate,  ///< the point is a vertex already
  TooClose,   ///< the point is nearer than asked for to a vertex that stays
  Rejected,   ///< the veto did not accept what the insertion would make
  Contended   ///< another worker owns a vertex of the cavity
};

enum class RemovalOutcome
{
  Removed,
  OnBox,    ///< vertices of kind Box stay
  Failed,   ///< the star could not be re-triangulated; the triangulation is unchanged
  Contended ///< another worker owns a vertex of the star; the triangulation is unchanged
};

enum class LockOutcome
{
  Locked,
  Dead,     ///< the simplex is no more
  Contended ///< another worker owns one of its vertices
};

/**
 * @brief The perturbed Delaunay triangulation of a set of points in a box, corners included.
 *
 * Insertion is Bowyer and Watson's from a simplex already known to be in conflict; removal
 * re-triangulates the star. Ties of the in-sphere test are broken by a symbolic perturbation that
 * depends on the points alone (Devillers and Teillaud 2003), so the triangulation is a function of the
 * set of vertices, whatever the order of insertions and removals.
 *
 * There is no infinite vertex: the domain is the box and facets on it have no neighbour. Points on the
 * box must have coordinates exactly equal to those of its faces.
 *
 * What an operation needs of scratch space, free lists and counters is in a Worker, one per thread.
 * Every operation first collects all simplices that it will change, then changes them; nothing is
 * modified before the first phase has succeeded.
 *
 * **Concurrency** (thesis, section 3.2.2). Workers with distinct numbers may operate at the same time;
 * a worker that is alone has the number 0 and takes no locks. Every vertex has a lock word. A worker
 * owns all vertices of every simplex that it deletes: it takes them while it collects, and gives up
 * (Contended) as soon as one is taken. It keeps what it owns, after a success too, until Unlock().
 *
 * Whoever owns D of the D+1 vertices of a simplex may read all of its record, and of its neighbours
 * which they are: neither it nor any neighbour can be deleted by somebody else, since each of its facets
 * has one of these D vertices (D - 1 >= 1 of them). Two workers cannot both own D of D+1 vertices, so
 * the marks and the state of a simplex are written by one worker at a time. All this is ordered by the
 * lock words: taking one acquires what its last owner released.
 *
 * **Helpers** (thesis, section 4.6.2). A worker may be told of a help sharing (Assistance). Threads that wait
 * there then test simplices of a large cavity for conflict, and compute circumballs of the new ones. They
 * read what the worker may read, write to places that it assigns, and have left before Insert() returns.
 * Marks, locks and links are the worker's own business. Created, Deleted and the new ids are the same, in
 * the same order, whoever helped.
 *
 * Complexity: linear in the simplices deleted and created for an insertion; for a removal linear in
 * (simplices created) x (vertices of the link).
 */
template <int D>
class Triangulation
{
public:
  static constexpr unsigned N = D + 1; ///< vertices of a simplex
  using Simplex = SimplexRecord<D>;
  using Vertex = VertexRecord<D>;

  /** Per-thread state: predicates, pools, scratch space, and what the last operation did. */
  struct Worker
  {
    /** @param id distinct for workers that operate at the same time; 0 for a worker that is alone */
    explicit Worker(const Triangulation& t, WorkerId id = 0)
      : Predicates(t.GetBox().Min, t.GetBox().Max)
      , Id(id)
    {
    }

    voxplex::Predicates<D> Predicates;

    /** Simplices made by the last successful operation. */
    Stack<SimplexId> Created;
    /** The vertex made by the last successful insertion. */
    VertexId NewVertex = None;
    /** The simplices that the last successful operation deleted; their ids may be in Created again. */
    Stack<SimplexId> Deleted;
    /** Simplices created so far. */
    std::uint64_t NumberOfCreated = 0;
    /** Whom the last operation that was Contended lost to. */
    WorkerId Winner = 0;
    /** Conflict tests so far, and how many the cached ball left to the predicates. */
    std::uint64_t BallTests = 0;
    std::uint64_t BallFailures = 0;

    /** Who helps with insertions; nobody as long as there is no sharing. */
    struct Assistance
    {
      LoopSharing* Sharing = nullptr;
      unsigned Number = 0; ///< of this worker's thread at the sharing
      /** The workers of the threads at the sharing, by number: a helper counts and computes in its own. */
      const std::vector<Worker*>* Team = nullptr;
      /** Fewest simplices of a level of a cavity (equally far from the seed) to ask for help, at least 1. */
      std::size_t FewestSimplices = 128;
      /** Fewest new simplices for help with their circumballs. */
      std::size_t FewestBalls = D == 3 ? 64 : 32;
      /** Iterations that a helper takes at a time. */
      std::size_t Grain = 16;

      bool Offered() const { return this->Sharing && this->Sharing->SomeoneIdle(); }
    };
    Assistance Help;

    std::size_t NumberOfOwned() const { return this->Owned.Size(); }

    /** For a veto: how many simplices the insertion under way would make. */
    std::size_t NumberOfNewSimplices() const { return this->Boundary.Size(); }
    /** The vertices of the k-th of them; what stands at `apex` is to be the new vertex. */
    const std::array<VertexId, N>& NewSimplex(std::size_t k, std::uint32_t& apex) const
    {
      apex = this->Boundary[k].Apex;
      return this->Boundary[k].V;
    }

    /** All tests of this worker; those that a cached ball decided included. */
    PredicateStatistics GetPredicateStatistics() const
    {
      PredicateStatistics statistics = this->Predicates.GetStatistics();
      statistics.Calls += this->BallTests - this->BallFailures;
      return statistics;
    }

  private:
    friend class Triangulation;

    /** A facet of the boundary of a cavity or star, seen from inside, and the new simplex on it. */
    struct BoundaryFacet
    {
      std::array<VertexId, N> V;          ///< vertices of the new simplex; V[Apex] is still to come
      std::array<std::uint32_t, N> Local; ///< their numbers in Link
      std::uint32_t Apex;
      SimplexId Outer;          ///< simplex beyond, or None; a number in Filling if OuterInFilling
      std::uint32_t OuterIndex; ///< number of the facet in Outer
      bool OuterInFilling = false;
    };
    /** A simplex that may be in conflict. */
    struct Candidate
    {
      SimplexId Id;
      SimplexId From;     ///< the simplex of the cavity that it was met from
      std::uint32_t Back; ///< number of From among its neighbours
      bool InConflict;
    };
    /** A simplex that will fill the star, before it has an id. */
    struct FillingSimplex
    {
      struct Neighbour
      {
        std::uint32_t Id;
        std::uint32_t Index;
        bool InFilling;
      };
      std::array<VertexId, N> V;
      std::array<Neighbour, N> Neighbours;
    };

    const WorkerId Id;
    Stack<VertexId> Owned;
    Stack<SimplexId> FreeSimplices;
    Stack<VertexId> FreeVertices;
    Stack<SimplexId> Touched; ///< simplices marked Outside
    Stack<Candidate> Candidates;
    Stack<BoundaryFacet> Boundary;
    Stack<VertexId> Joined;      ///< vertices of the cavity, with repetitions
    Stack<VertexId> Link;        ///< vertices of Boundary; Link[v.Local] == v
    Stack<Point<D>> LinkOffsets; ///< of the link's vertices from the new vertex
    Stack<double> LinkNorms2;    ///< squared norms of the offsets
    RidgeTable<D> Ridges;
    EdgeTable Edges;
    FacetTable<D> Front;
    Stack<FillingSimplex> Filling;
  };

  /** Decides on an insertion by what it would make. */
  class InsertionVeto
  {
  public:
    /** Reads the worker's prospects; the worker owns all their vertices. */
    virtual bool Accepts(const Worker& worker) = 0;

  protected:
    ~InsertionVeto() = default;
  };

  /** Triangulates the corners of the box. */
  explicit Triangulation(const Box<D>& box);

  const Box<D>& GetBox() const { return this->Domain; }

  /**
   * Takes all vertices of a simplex.
   * @param generation State(s).Generation when the caller met the simplex
   */
  LockOutcome Lock(Worker& worker, SimplexId s, std::uint32_t generation);

  /** Takes a vertex. @return false if another worker owns it: worker.Winner */
  bool TryLock(Worker& worker, VertexId v);

  /** Gives back all vertices that the worker owns. */
  void Unlock(Worker& worker);

  /** Whether the worker may change the star of a vertex. A worker that is alone owns everything. */
  bool Owns(const Worker& worker, VertexId v) const;
  /** Whether it owns all vertices of a simplex: it may delete it. */
  bool OwnsAll(const Worker& worker, const std::array<VertexId, N>& v) const;
  /** Whether it owns all but one: it may mark the simplex, and write its state and its neighbours. */
  bool OwnsFacet(const Worker& worker, SimplexId s) const;

  /**
   * Inserts a point.
   * @param p inside or on the box
   * @param seed a living simplex that should be in conflict with p; the worker owns at least D of
   *   its vertices, unless it is alone
   * @param clearance if positive: refuse points nearer than this to a vertex, free ones excepted if
   *   the point is a feature point (they give way)
   * @param veto if given: asked before anything is changed
   * On success worker.Created and worker.NewVertex tell what was made, and the worker owns all their
   * vertices.
   * @throws std::bad_alloc with the triangulation unchanged
   */
  InsertionOutcome Insert(Worker& worker, const Point<D>& p, VertexKind kind, SimplexId seed,
    double clearance = 0.0, InsertionVeto* veto = nullptr);

  /**
   * Removes a living vertex that is not of kind Box; unless the worker is alone it owns the vertex. A
   * vertex of another kind may lie on the box, but not in a corner. On success worker.Created tells
   * what was made.
   * @throws std::bad_alloc with the triangulation unchanged
   */
  RemovalOutcome Remove(Worker& worker, VertexId v);

  /**
   * A simplex in conflict with p, by walking from a living simplex; None if p is a vertex. Nobody may
   * operate meanwhile.
   * Expected O(n^(1/D)) from a random start, O(1) from one nearby.
   */
  SimplexId FindConflict(Worker& worker, const Point<D>& p, SimplexId hint) const;

  /** True if p is in the (perturbed) open circumball of a simplex; never wrong. Inlined by force: a
   * call costs more than the test. */
  [[gnu::always_inline]] bool InConflict(Worker& worker, SimplexId s, const Point<D>& p) const
  {
    ++worker.BallTests;
    const int side = SideOfCircumball(this->Simplices[s].Ball, p);
    if (side != 0)
    {
      return side > 0;
    }
    return this->InConflictExactly(worker, s, p); // NaN comes here too
  }

  /** The circumball: the cached one if reliable, else computed exactly and rounded. */
  Circumball<D> GetCircumball(SimplexId s) const
  {
    const Circumball<D>& ball = this->Simplices[s].Ball;
    return ball.Radius2 >= 0.0 ? ball : this->ComputeBallExactly(s);
  }

  const Simplex& GetSimplex(SimplexId s) const { return this->Simplices[s]; }
  const Vertex& GetVertex(VertexId v) const { return this->Vertices[v]; }
  const Point<D>& Position(VertexId v) const { return this->Vertices[v].Position; }

  SimplexState& State(SimplexId s) { return this->States[s]; }
  const SimplexState& State(SimplexId s) const { return this->States[s]; }
  bool IsAlive(SimplexId s) const { return this->Marks[s] != SimplexMark::Unused; }
  /** The smallest id of a simplex that is. There is always one: the box is filled. */
  SimplexId FirstAlive() const
  {
    SimplexId s = 0;
    while (!this->IsAlive(s))
    {
      ++s;
    }
    return s;
  }

  /** All simplex ids lie below this one; test each with IsAlive(). */
  SimplexId SimplexIdEnd() const { return this->NextSimplex.load(std::memory_order_relaxed); }
  /** All vertex ids lie below this one; test each with GetVertex(v).Alive. */
  VertexId VertexIdEnd() const { return this->NextVertex.load(std::memory_order_relaxed); }

  /** Bytes of the vertex and simplex records in use or ever used. */
  std::uint64_t MemoryBytes() const;

  /**
   * What is wrong with the triangulation, empty if nothing: orientation, mutual neighbours, facets
   * shared rightly, hull on the box, local (perturbed) Delaunay property, incidence.
   */
  std::vector<std::string> Verify(Worker& worker) const;

private:
  using BoundaryFacet = typename Worker::BoundaryFacet;
  using FillingSimplex = typename Worker::FillingSimplex;
  using Candidate = typename Worker::Candidate;

  bool InConflictExactly(Worker& worker, SimplexId s, const Point<D>& p) const;
  Circumball<D> ComputeBallExactly(SimplexId s) const;
  SimplexId FindConflictExactly(Worker& worker, const Point<D>& p, SimplexId hint) const;
  void VerifySimplex(Worker& worker, SimplexId s, std::vector<std::string>& complaints) const;
  std::array<const Point<D>*, N> Points(const std::array<VertexId, N>& v) const;
  static std::uint32_t IndexOfNeighbour(const Simplex& simplex, SimplexId neighbour);
  std::uint32_t NumberVertex(Worker& worker, VertexId v);
  bool TryOwn(Worker& worker, VertexId v);
  bool TryLockAll(Worker& worker, const std::array<VertexId, N>& v);
  void SetVertices(Simplex& simplex, const std::array<VertexId, N>& v);
  void BuildCorners();

  // Pools. Reserve...() may throw and leaves all as it was; what follows it does not throw.
  void ReserveSimplices(Worker& worker, std::size_t n);
  void ReserveVertex(Worker& worker);
  SimplexId NewSimplex(Worker& worker);
  VertexId NewVertex(Worker& worker, const Point<D>& p, VertexKind kind);
  void WriteSimplex(const Worker& worker, SimplexId s, const std::array<VertexId, N>& v);
  void Kill(Worker& worker, SimplexId s);
  void RestoreMarks(Worker& worker);

  // Insertion
  [[nodiscard]] bool CollectCavity(Worker& worker, const Point<D>& p, SimplexId seed);
  [[nodiscard]] bool ExpandWithHelp(Worker& worker, const Point<D>& p, unsigned planes);
  [[nodiscard]] bool ExpandLevel(
    Worker& worker, const Point<D>& p, unsigned planes, std::size_t first, std::size_t last);
  void TestCandidates(Worker& worker, const Point<D>& p, std::size_t level);
  void FillWithHelp(Worker& worker, VertexId apex);
  [[gnu::always_inline]] inline void PlaceSimplex(
    const Worker& worker, SimplexId s, Simplex& simplex, BoundaryFacet& facet, VertexId apex);
  void FillCavity(Worker& worker, VertexId apex);
  void NumberLink(Worker& worker, const Point<D>& apex);
  inline void SetBall(
    const Worker& worker, Simplex& simplex, const BoundaryFacet& facet, const Point<D>& apex);
  inline void LinkRidges(Worker& worker);
  inline void LinkEdges(Worker& worker, bool closed) requires(D == 3);
  bool IsClear(Worker& worker, const Point<D>& p, VertexKind kind, double clearance) const;
  inline void Prefetch(SimplexId s, const Simplex& simplex, std::uint32_t newVertex) const;
  unsigned PlanesOfPoint(const Point<D>& p) const;
  bool OnPlane(const std::array<VertexId, N>& v, unsigned except, unsigned planes) const;

  // Removal
  [[nodiscard]] bool CollectStar(Worker& worker, VertexId v);
  bool FillStar(Worker& worker, unsigned planes);
  VertexId BestApex(Worker& worker, const BoundaryFacet& facet);
  void CommitFilling(Worker& worker);
  typename FacetTable<D>::Face LocalFacet(const BoundaryFacet& facet) const;

  Box<D> Domain;
  ChunkedArray<Vertex> Vertices;
  ChunkedArray<Simplex> Simplices;
  ChunkedArray<SimplexMark, 16> Marks; ///< apart: every step of a cavity search reads one
  ChunkedArray<SimplexState> States;
  std::atomic<std::uint32_t> NextVertex{ 0 };
  std::atomic<std::uint32_t> NextSimplex{ 0 };
};

// Small steps of the hot paths, inlined into insertion and removal.

//------------------------------------------------------------------------------------------------
template <int D>
inline std::array<const Point<D>*, Triangulation<D>::N> Triangulation<D>::Points(
  const std::array<VertexId, N>& v) const
{
  std::array<const Point<D>*, N> points;
  for (unsigned i = 0; i < N; ++i)
  {
    points[i] = &this->Position(v[i]);
  }
  return points;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline std::uint32_t Triangulation<D>::NumberVertex(Worker& worker, VertexId v)
{
  assert(this->Owns(worker, v));
  std::uint32_t& local = this->Vertices[v].Local;
  if (local >= worker.Link.Size() || worker.Link[local] != v)
  {
    local = static_cast<std::uint32_t>(worker.Link.Size());
    worker.Link.Push(v); // whoever calls makes room
  }
  return local;
}

//------------------------------------------------------------------------------------------------
// Without a branch: which neighbour it is cannot be predicted.
template <int D>
inline std::uint32_t Triangulation<D>::IndexOfNeighbour(const Simplex& simplex, SimplexId neighbour)
{
  std::uint32_t index = 0;
  for (unsigned i = 1; i < N; ++i)
  {
    index += simplex.N[i] == neighbour ? i : 0u;
  }
  return index;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline SimplexId Triangulation<D>::NewSimplex(Worker& worker)
{
  const SimplexId s = worker.FreeSimplices.Pop();
  this->Marks[s] = SimplexMark::Alive;
  return s;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline VertexId Triangulation<D>::NewVertex(Worker& worker, const Point<D>& p, VertexKind kind)
{
  const VertexId v = worker.FreeVertices.Pop();
  assert(this->Owns(worker, v));
  Vertex& vertex = this->Vertices[v];
  vertex.Position = p;
  vertex.Incident = None;
  vertex.Local = 0;
  vertex.Kind = kind;
  vertex.Alive = true;
  return v;
}

//------------------------------------------------------------------------------------------------
// Whoever asks has made room in Owned.
template <int D>
inline bool Triangulation<D>::TryOwn(Worker& worker, VertexId v)
{
  if (worker.Id == 0)
  {
    return true;
  }
  const std::atomic_ref<WorkerId> owner(this->Vertices[v].Owner);
  WorkerId current = owner.load(std::memory_order_relaxed);
  if (current == worker.Id)
  {
    return true;
  }
  if (current == 0 &&
    owner.compare_exchange_strong(
      current, worker.Id, std::memory_order_acquire, std::memory_order_relaxed))
  {
    worker.Owned.Push(v);
    return true;
  }
  worker.Winner = current;
  return false;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline bool Triangulation<D>::Owns(const Worker& worker, VertexId v) const
{
  // const_cast: atomic_ref to const is not in C++20; only read here
  return worker.Id == 0 ||
    std::atomic_ref<WorkerId>(const_cast<WorkerId&>(this->Vertices[v].Owner))
      .load(std::memory_order_relaxed) == worker.Id;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline bool Triangulation<D>::OwnsAll(const Worker& worker, const std::array<VertexId, N>& v) const
{
  bool all = true;
  for (const VertexId w : v)
  {
    all = all && this->Owns(worker, w);
  }
  return all;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline bool Triangulation<D>::OwnsFacet(const Worker& worker, SimplexId s) const
{
  unsigned others = 0;
  for (const VertexId v : this->Simplices[s].V)
  {
    others += this->Owns(worker, v) ? 0 : 1;
  }
  return others <= 1;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline bool Triangulation<D>::TryLock(Worker& worker, VertexId v)
{
  worker.Owned.MakeRoom(1);
  return this->TryOwn(worker, v);
}

//------------------------------------------------------------------------------------------------
template <int D>
inline bool Triangulation<D>::TryLockAll(Worker& worker, const std::array<VertexId, N>& v)
{
  worker.Owned.MakeRoom(N);
  for (const VertexId w : v)
  {
    if (!this->TryOwn(worker, w))
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
// Before it owns anything the worker can only guess which vertices these are; if the simplex is still
// the same once they are taken, the guess was right: whoever deleted it owned its vertices then, and
// whoever reused its record owned the new ones, so one of the vertices that were taken tells of the
// new generation.
template <int D>
inline LockOutcome Triangulation<D>::Lock(Worker& worker, SimplexId s, std::uint32_t generation)
{
  const SimplexState& state = this->States[s];
  if (state.CurrentGeneration() != generation)
  {
    return LockOutcome::Dead;
  }
  if (worker.Id == 0)
  {
    return LockOutcome::Locked;
  }
  std::array<VertexId, N> v;
  for (unsigned i = 0; i < N; ++i)
  {
    v[i] = std::atomic_ref<VertexId>(this->Simplices[s].V[i]).load(std::memory_order_acquire);
  }
  if (!this->TryLockAll(worker, v))
  {
    return state.CurrentGeneration() != generation ? LockOutcome::Dead : LockOutcome::Contended;
  }
  return state.CurrentGeneration() != generation ? LockOutcome::Dead : LockOutcome::Locked;
}

//------------------------------------------------------------------------------------------------
template <int D>
inline void Triangulation<D>::Unlock(Worker& worker)
{
  for (const VertexId v : worker.Owned)
  {
    assert(this->Owns(worker, v));
    std::atomic_ref<WorkerId>(this->Vertices[v].Owner).store(0, std::memory_order_release);
  }
  worker.Owned.Clear();
}

//------------------------------------------------------------------------------------------------
// Others may be guessing (Lock): whoever reads a vertex here also sees that it exists.
template <int D>
inline void Triangulation<D>::SetVertices(Simplex& simplex, const std::array<VertexId, N>& v)
{
  for (unsigned i = 0; i < N; ++i)
  {
    std::atomic_ref<VertexId>(simplex.V[i]).store(v[i], std::memory_order_release);
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
inline void Triangulation<D>::WriteSimplex(
  [[maybe_unused]] const Worker& worker, SimplexId s, const std::array<VertexId, N>& v)
{
  assert(this->OwnsAll(worker, v));
  Simplex& simplex = this->Simplices[s];
  this->SetVertices(simplex, v);
  std::array<const Point<D>*, N> points;
  for (unsigned i = 0; i < N; ++i)
  {
    Vertex& vertex = this->Vertices[v[i]];
    vertex.Incident = s;
    points[i] = &vertex.Position;
  }
  if (!ComputeCircumball<D>(points.data(), simplex.Ball))
  {
    simplex.Ball.Radius2 = std::numeric_limits<double>::quiet_NaN();
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
inline void Triangulation<D>::Kill(Worker& worker, SimplexId s)
{
  assert(this->OwnsAll(worker, this->Simplices[s].V));
  this->Marks[s] = SimplexMark::Unused;
  SimplexState& state = this->States[s];
  std::atomic_ref<std::uint32_t>(state.Generation)
    .store(state.Generation + 1, std::memory_order_relaxed);
  state.Label = 0;
  state.Labelled = false;
  state.NearSurface = false;
  worker.FreeSimplices.Push(s);
}

extern template class Triangulation<3>;
extern template class Triangulation<4>;

} // namespace voxplex

#endif
