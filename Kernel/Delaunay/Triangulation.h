// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Triangulation.h
 * @brief The Delaunay triangulation of points in a box, with insertion and removal.
 */
#ifndef voxplex_Triangulation_h
#define voxplex_Triangulation_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Outcomes.h"
#include "Delaunay/RidgeTable.h"
#include "Delaunay/Stack.h"
#include "Delaunay/StarFilling.h"
#include "Delaunay/Stores.h"
#include "Geometry/Box.h"
#include "Geometry/Predicates.h"
#include "Parallel/LoopSharing.h"

#include <atomic>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace voxplex
{

/**
 * @brief The perturbed Delaunay triangulation of a set of points in a box, corners included.
 *
 * Insertion is the Bowyer-Watson algorithm. It starts from a simplex that is known to be in
 * conflict with the point. Removal re-triangulates the star. Ties of the in-sphere test are broken
 * by a symbolic perturbation that depends only on the points (Devillers and Teillaud 2003). So the
 * triangulation depends only on the set of vertices, not on the order of insertions and removals.
 *
 * There is no infinite vertex: the domain is the box, and facets on the box have no neighbour. The
 * coordinates of points on the box must be exactly equal to those of its faces.
 *
 * A Worker, one per thread, has the scratch space, free lists and counters of operations. Every
 * operation first collects all simplices that it will change, then changes them. Nothing is
 * modified before the first phase has succeeded.
 *
 * **Concurrency** (thesis, section 3.2.2). Workers with distinct numbers may operate at the same
 * time. A worker that is alone has the number 0, and takes no locks. Every vertex has a lock word.
 * A worker must own all vertices of every simplex that it deletes. It takes them while it collects.
 * If another worker owns a vertex, the operation stops (Contended). A worker keeps its vertices
 * until Unlock(), also after a success.
 *
 * A worker that owns D of the D+1 vertices of a simplex may read the whole record of the simplex,
 * and which simplices its neighbours are. No other worker can delete the simplex or a neighbour,
 * since each facet of the simplex has at least D - 1 >= 1 of the owned vertices. Two workers cannot
 * both own D of D+1 vertices. So only one worker at a time writes the marks and the state of a
 * simplex. The lock words order these accesses: taking a lock acquires everything that the last
 * owner wrote before it released the lock.
 *
 * **Zones.** Workers without locks may operate at the same time if each has a zone (Worker::Zone)
 * and the zones are disjoint. A worker owns the vertices inside its zone, and no others. All that is
 * said about owners holds. So what a worker does in its zone does not depend on the other workers.
 *
 * **Helpers** (thesis, section 4.6.2). A worker may have a LoopSharing (Assistance). Then waiting
 * threads test simplices of a large cavity for conflict, and compute circumballs of new simplices.
 * They read only data that the worker may read, and write only to places that it assigns. They have
 * left before Insert() returns. Only the worker itself handles marks, locks and links. Created,
 * Deleted and the new ids do not depend on the helpers, nor does their order.
 *
 * Complexity: an insertion is linear in the number of simplices deleted and created. A removal is
 * linear in (simplices created) x (vertices of the link).
 */
template <int D>
class Triangulation
{
public:
  static constexpr unsigned N = D + 1; ///< vertices of a simplex
  using Simplex = SimplexRecord<D>;
  using Vertex = VertexRecord<D>;

  /** Per-thread state: predicates, pools, scratch space, and the results of the last operation. */
  struct Worker
  {
    /**
     * @param id different for workers that operate at the same time; 0 for a worker that is alone
     */
    explicit Worker(const Triangulation& t, WorkerId id = 0)
      : Predicates(t.GetBox().Min, t.GetBox().Max)
      , Id(id)
    {
    }

    voxplex::Predicates<D> Predicates;

    /** The simplices that the last successful operation created. */
    Stack<SimplexId> Created;
    /** The vertex that the last successful insertion created. */
    VertexId NewVertex = None;
    /** The simplices that the last successful operation deleted. Created may reuse their ids. */
    Stack<SimplexId> Deleted;
    /** Number of simplices created so far. */
    std::uint64_t NumberOfCreated = 0;
    /**
     * If not null: where the worker, which then has the number 0, may operate. An operation that
     * needs a vertex outside is Contended. The zones of workers that operate at the same time must
     * be disjoint.
     */
    const HalfOpenBox<D>* Zone = nullptr;
    /** The owner of the contended vertex in the last operation that was Contended. */
    WorkerId Winner = 0;
    /** Number of conflict tests so far, and of those that the cached ball could not decide. */
    std::uint64_t BallTests = 0;
    std::uint64_t BallFailures = 0;

    /** The helpers of insertions. If Sharing is null, there are none. */
    struct Assistance
    {
      LoopSharing* Sharing = nullptr;
      unsigned Number = 0; ///< number of this worker's thread in Sharing
      /** The workers of the threads in Sharing, by number. A helper uses its own worker. */
      const std::vector<Worker*>* Team = nullptr;
      /**
       * If a level of a cavity has at least this number of simplices, helpers may test. A level is
       * the set of simplices at the same distance from the seed. At least 1.
       */
      std::size_t FewestSimplices = 128;
      /** If there are at least this number of new simplices, helpers may compute circumballs. */
      std::size_t FewestBalls = D == 3 ? 64 : 32;
      /** Iterations of a chunk. */
      std::size_t Grain = 16;

      bool Offered() const { return this->Sharing && this->Sharing->SomeoneIdle(); }
    };
    Assistance Help;

    std::size_t NumberOfOwned() const { return this->Owned.Size(); }

    /** For a veto: the number of simplices that the current insertion would create. */
    std::size_t NumberOfNewSimplices() const { return this->Boundary.Size(); }
    /** For a veto: the vertices of new simplex k. The new vertex will be at position `apex`. */
    const std::array<VertexId, N>& NewSimplex(std::size_t k, std::uint32_t& apex) const
    {
      apex = this->Boundary[k].Apex;
      return this->Boundary[k].V;
    }

    /** Statistics of all tests of this worker, including tests that a cached ball decided. */
    PredicateStatistics GetPredicateStatistics() const
    {
      PredicateStatistics statistics = this->Predicates.GetStatistics();
      statistics.Calls += this->BallTests - this->BallFailures;
      return statistics;
    }

  private:
    friend class Triangulation;

    /** A facet on the boundary of a cavity or star, seen from inside, and the new simplex on it. */
    struct BoundaryFacet
    {
      std::array<VertexId, N> V;          ///< vertices of the new simplex; V[Apex] is set later
      std::array<std::uint32_t, N> Local; ///< numbers of the vertices in Link
      std::uint32_t Apex;
      SimplexId Outer;          ///< outer simplex or None; if OuterInFilling, a number in Filling
      std::uint32_t OuterIndex; ///< number of the facet in Outer
      bool OuterInFilling;      ///< in a star only, as Closed
      bool Closed;              ///< the simplices on both sides are known
    };
    /** A simplex that may be in conflict. */
    struct Candidate
    {
      SimplexId Id;
      SimplexId From;     ///< the cavity's simplex from which it was found
      std::uint32_t Back; ///< number of From among its neighbours
      bool InConflict;
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
    Stack<Point<D>> LinkOffsets; ///< the link's vertices minus the new vertex
    Stack<double> LinkNorms2;    ///< squared norms of the offsets
    RidgeTable<D> Ridges;
    EdgeTable Edges;
    StarFilling<D> Star;
  };

  /** Accepts or rejects an insertion by its new simplices. */
  class InsertionVeto
  {
  public:
    /** May read the worker's NewSimplex(). The worker owns all their vertices. */
    virtual bool Accepts(const Worker& worker) = 0;

  protected:
    ~InsertionVeto() = default;
  };

  /** Triangulates the corners of the box. */
  explicit Triangulation(const Box<D>& box);

  const Box<D>& GetBox() const { return this->Domain; }

  /**
   * Locks all vertices of a simplex.
   * @param generation the value of State(s).Generation when the caller found the simplex. If the
   *   worker has a zone, a living simplex must have a vertex in it: otherwise another worker may
   *   delete the simplex meanwhile.
   */
  LockOutcome Lock(Worker& worker, SimplexId s, std::uint32_t generation);

  /** Locks a vertex. @return false if another worker owns the vertex: worker.Winner */
  bool TryLock(Worker& worker, VertexId v);

  /** Unlocks all vertices that the worker owns. */
  void Unlock(Worker& worker);

  /** Whether the worker may change the star of a vertex. A worker that is alone owns everything. */
  bool Owns(const Worker& worker, VertexId v) const;
  /** Whether the worker owns all vertices of a simplex. Then it may delete the simplex. */
  bool OwnsAll(const Worker& worker, const std::array<VertexId, N>& v) const;
  /**
   * Whether the worker owns at least D vertices of a simplex. Then it may write the simplex's mark,
   * state and neighbours.
   */
  bool OwnsFacet(const Worker& worker, SimplexId s) const;

  /**
   * Inserts a point.
   * @param p inside or on the box
   * @param seed a living simplex that should be in conflict with p. Unless the worker is alone, it
   *   must own at least D vertices of the seed.
   * @param clearance if positive: the point is refused if it is nearer than this to a vertex. If
   *   the point is a feature point, vertices of the kinds Free and Shared do not count.
   * @param veto if not null: called before anything is changed
   * On success, worker.Created and worker.NewVertex have the new simplices and the new vertex, and
   * the worker owns all their vertices.
   * @throws std::bad_alloc; then the triangulation is unchanged
   */
  InsertionOutcome Insert(Worker& worker, const Point<D>& p, VertexKind kind, SimplexId seed,
    double clearance = 0.0, InsertionVeto* veto = nullptr);

  /**
   * Removes a living vertex that is of kind Free or Feature. Unless the worker is alone, it must own the
   * vertex. A vertex of another kind may lie on the box, but not on a corner. On success,
   * worker.Created has the new simplices.
   * @throws std::bad_alloc; then the triangulation is unchanged
   */
  RemovalOutcome Remove(Worker& worker, VertexId v);

  /** Makes a free vertex a shared one, which stays. No worker may operate meanwhile. */
  void Share(VertexId v)
  {
    Vertex& vertex = this->Vertices[v];
    vertex.Kind = vertex.Kind == VertexKind::Free ? VertexKind::Shared : vertex.Kind;
  }

  /**
   * Replaces everything by the union of triangulations of boxes that are stacked along the last axis.
   * The box must be their union. Two neighbouring boxes must have a common face, and the same
   * vertices on it; the triangulations of the face are then the same, since they are functions of
   * the vertices. The union is Delaunay in each box. States are copied; ids are new; generations are new for their ids. No worker may
   * operate on the union.
   *
   * Takes time O(n log n) for the vertices and facets on common faces, and linear time for the rest.
   * @param parts in ascending order
   * @throws std::logic_error if a facet of a common face has no partner; std::bad_alloc. In both
   *   cases the triangulation cannot be used any more
   */
  void Join(std::span<const Triangulation* const> parts);

  /**
   * Gives vertices and simplices the numbers 0, 1, ... in an order that depends on the points
   * alone: vertices along a Hilbert curve, simplices by their smallest vertex. So neighbours lie near
   * each other in memory. Ids and generations from before the call are void. No worker from before
   * the call may operate again.
   *
   * Takes O(n log n) time, and about 75 bytes for each simplex while it runs.
   * @throws std::bad_alloc; then the triangulation cannot be used any more
   */
  void Renumber(unsigned threads);

  /**
   * Finds a simplex in conflict with p by a walk from a living simplex. Returns None if p is a
   * vertex. No worker may change the triangulation meanwhile. Expected time: O(n^(1/D)) from a
   * random simplex, O(1) from a near one.
   */
  SimplexId FindConflict(Worker& worker, const Point<D>& p, SimplexId hint) const;

  /** True if p is in the (perturbed) open circumball of a simplex. The answer is exact. Forced
   * inline, since a call costs more than the test. */
  [[gnu::always_inline]] bool InConflict(Worker& worker, SimplexId s, const Point<D>& p) const
  {
    ++worker.BallTests;
    const int side = SideOfCircumball(this->Simplices[s].Ball, p);
    if (side != 0)
    {
      return side > 0;
    }
    return this->InConflictExactly(worker, s, p); // also if the cached ball is NaN
  }

  /** The cached circumball. If it is not reliable, it is computed exactly and rounded. */
  Circumball<D> GetCircumball(SimplexId s) const
  {
    const Circumball<D>& ball = this->Simplices[s].Ball;
    return ball.Radius2 >= 0.0 ? ball : this->ComputeBallExactly(s);
  }

  /** Frees states. Afterwards only vertices and simplices can be read, their labels, and whether they are alive. */
  void Freeze() { this->States.Clear(); }

  const Simplex& GetSimplex(SimplexId s) const { return this->Simplices[s]; }
  const Vertex& GetVertex(VertexId v) const { return this->Vertices[v]; }
  const Point<D>& Position(VertexId v) const { return this->Vertices[v].Position; }
  /** The positions of some vertices. */
  template <std::size_t M>
  std::array<const Point<D>*, M> Points(const std::array<VertexId, M>& v) const
  {
    std::array<const Point<D>*, M> points;
    for (std::size_t i = 0; i < M; ++i)
    {
      points[i] = &this->Position(v[i]);
    }
    return points;
  }

  /** Several threads may call this at once, those for the same vertex with the same answer. */
  void SetOnInterface(VertexId v, bool isOn)
  {
    // Relaxed: nobody reads it before the threads are joined.
    std::atomic_ref<bool>(this->Vertices[v].OnInterface).store(isOn, std::memory_order_relaxed);
  }
  SimplexState& State(SimplexId s) { return this->States[s]; }
  const SimplexState& State(SimplexId s) const { return this->States[s]; }
  bool IsAlive(SimplexId s) const { return this->Marks[s] != SimplexMark::Unused; }
  /** The smallest id of a living simplex. There always is one, since the simplices fill the box. */
  SimplexId FirstAlive() const
  {
    SimplexId s = 0;
    while (!this->IsAlive(s))
    {
      ++s;
    }
    return s;
  }

  /**
   * The label of each simplex in the mesh, by id: the state of ManifoldLabeller. Renumber() carries it.
   * Empty before the first inspection, and after Join().
   */
  UninitialisedVector<LabelId>& Labels() { return this->MeshLabels; }
  const UninitialisedVector<LabelId>& Labels() const { return this->MeshLabels; }

  /** All simplex ids are below this one. Test each with IsAlive(). */
  SimplexId SimplexIdEnd() const { return this->NextSimplex.load(std::memory_order_relaxed); }
  /** All vertex ids are below this one. Test each with GetVertex(v).Alive. */
  VertexId VertexIdEnd() const { return this->NextVertex.load(std::memory_order_relaxed); }

  /** The positions of vertices, for the functions of Geometry/. */

  /** Bytes of the records below VertexIdEnd() and SimplexIdEnd(), including unused records. */
  std::uint64_t MemoryBytes() const;

private:
  template <int>
  friend class TriangulationVerifier; // of the tests

  using BoundaryFacet = typename Worker::BoundaryFacet;
  using Candidate = typename Worker::Candidate;

  bool InConflictExactly(Worker& worker, SimplexId s, const Point<D>& p) const;
  Circumball<D> ComputeBallExactly(SimplexId s) const;
  SimplexId WalkExactly(Worker& worker, const Point<D>& p, SimplexId s) const;
  static std::uint32_t IndexOfNeighbour(const Simplex& simplex, SimplexId neighbour);
  std::uint32_t NumberVertex(Worker& worker, VertexId v);
  bool TryOwn(Worker& worker, VertexId v);
  bool TryLockAll(Worker& worker, const std::array<VertexId, N>& v);
  void SetVertices(Simplex& simplex, const std::array<VertexId, N>& v);
  void BuildCorners();

  // Pools. The Reserve...() functions may throw, and then change nothing. The functions after them
  // do not throw.
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
  inline void Prefetch(SimplexId s, const Simplex& simplex, VertexId newVertex) const;
  unsigned PlanesOfPoint(const Point<D>& p) const;
  bool OnPlane(const std::array<VertexId, N>& v, unsigned except, unsigned planes) const;

  // Removal
  [[nodiscard]] bool CollectStar(Worker& worker, VertexId v);
  inline void PrefetchStar(SimplexId s, const Simplex& simplex) const;
  void NumberStar(Worker& worker);
  static typename FacetTable<D>::Face FaceOf(
    const std::array<std::uint32_t, N>& local, unsigned apex);
  bool FillStar(Worker& worker, unsigned planes);
  bool FillFacet(Worker& worker, const BoundaryFacet& facet, unsigned planes);
  std::uint32_t GuessApex(Worker& worker, std::size_t facet) const;
  bool FindApex(Worker& worker, BoundaryFacet& facet, std::uint32_t guess, Circumball<D>& ball);
  void CommitFilling(Worker& worker);

  Box<D> Domain;
  ChunkedArray<Vertex> Vertices;
  ChunkedArray<Simplex> Simplices;
  ChunkedArray<SimplexMark, 16> Marks; ///< separate, since every step of a cavity search reads one
  ChunkedArray<SimplexState> States;
  UninitialisedVector<LabelId> MeshLabels;
  std::atomic<std::uint32_t> NextVertex{ 0 };
  std::atomic<std::uint32_t> NextSimplex{ 0 };
};

// Small steps of the hot paths, inlined into insertion and removal.

//------------------------------------------------------------------------------------------------
//------------------------------------------------------------------------------------------------
template <int D>
inline std::uint32_t Triangulation<D>::NumberVertex(Worker& worker, VertexId v)
{
  assert(this->Owns(worker, v));
  std::uint32_t& local = this->Vertices[v].Local;
  if (local >= worker.Link.Size() || worker.Link[local] != v)
  {
    local = static_cast<std::uint32_t>(worker.Link.Size());
    worker.Link.Push(v); // the caller has made room
  }
  return local;
}

//------------------------------------------------------------------------------------------------
// Has no branch, since the index is unpredictable.
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
  assert(worker.Zone || this->Owns(worker, v)); // an unused vertex is in no zone
  Vertex& vertex = this->Vertices[v];
  vertex.Position = p;
  vertex.Incident = None;
  vertex.Local = 0;
  vertex.Kind = kind;
  vertex.Alive = true;
  return v;
}

//------------------------------------------------------------------------------------------------
// The caller has made room in Owned.
template <int D>
[[gnu::always_inline]] inline bool Triangulation<D>::TryOwn(Worker& worker, VertexId v)
{
  if (worker.Id == 0)
  {
    return !worker.Zone || worker.Zone->Contains(this->Vertices[v].Position);
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
  if (worker.Id == 0)
  {
    return !worker.Zone || worker.Zone->Contains(this->Vertices[v].Position);
  }
  // const_cast: C++20 has no atomic_ref to const. The value is only read.
  return std::atomic_ref<WorkerId>(const_cast<WorkerId&>(this->Vertices[v].Owner))
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
  worker.Owned.ReserveMore(1);
  return this->TryOwn(worker, v);
}

//------------------------------------------------------------------------------------------------
template <int D>
[[gnu::always_inline]] inline bool Triangulation<D>::TryLockAll(
  Worker& worker, const std::array<VertexId, N>& v)
{
  worker.Owned.ReserveMore(N);
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
// Before the worker owns vertices of the simplex, it can only guess them: another worker may reuse
// the record at the same time. If the generation is unchanged after the vertices are locked, the
// guess was right. Proof: a worker that deleted the simplex owned its vertices then. A worker that
// reused the record owned the new vertices. So if the simplex was deleted, one of the locked
// vertices makes the new generation visible.
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
    return !worker.Zone || this->TryLockAll(worker, this->Simplices[s].V) ? LockOutcome::Locked
                                                                          : LockOutcome::Contended;
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
// Other workers may guess the vertices at the same time (Lock). By the release, a worker that reads
// a vertex id here also sees that the vertex exists.
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
  state.Examined = false;
  worker.FreeSimplices.Push(s);
}

extern template class Triangulation<3>;
extern template class Triangulation<4>;

} // namespace voxplex

#endif
