// Which light samples a vertex sees, by rays in packets [P004 section 4.1].
//
// Leaves of the light tree that follow one another lie close together, so 16 of them make a
// coherent packet from one place. Only samples that matter are asked for: those in front of a face
// around the vertex (of surfaces: that face it), and, where a material scatters light from behind,
// those behind it.
//
// Where vertices nearby are done already and agree on all leaves of a node of the tree, a few rays
// probe the node; only where these disagree are its children looked at, and at last all leaves
// traced. Edges of shadows that have moved on into such a node are then followed: wherever a traced
// leaf is not what is supposed of one next to it, that one is traced, too. What is missed are
// islands that no probe hits. (The paper traces all.)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/relight/sample_neighbours.h"
#include "lobelia/relight/vertex_faces.h"
#include "lobelia/relight/visibility_cut.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::relight {

// For samples of any number; of as many levels as there are only where that is a power of two.
LeafBits leafBits(const LightSamples& samples);

// For one thread; keeps its memory from vertex to vertex.
class VertexTracer {
 public:
  // Keeps references. samples: in the order of the tree's leaves. neighbours: of these; may be null
  // where traceAdaptively() is not called.
  VertexTracer(const Tracer& tracer, const LightSamples& samples,
               const SampleNeighbours* neighbours = nullptr);

  // Says which leaves matter and that none is visible yet; the other functions go on from there.
  void prepare(std::span<const FacePlace> faces, LeafBits* bits);
  void traceAll(LeafBits* bits);
  // Those of some leaves that matter and were not traced since prepare().
  void trace(std::span<const uint32_t> leaves, LeafBits* bits);
  // nearby: bits of vertices that are done; key: of the random choice of probes.
  void traceAdaptively(std::span<const LeafBits* const> nearby, uint64_t key, LeafBits* bits);

  uint64_t rays() const { return rays_; }  // since it was made

 private:
  struct Node {
    int level;
    uint32_t place;
    bool visible;  // what is expected of all leaves
  };
  uint64_t facing(const FacePlace& face, float side, uint32_t word) const;
  void assign(uint64_t leaves, uint32_t word, uint8_t face);
  void push(uint32_t leaf, LeafBits* bits);
  void queue(uint32_t leaf, LeafBits* bits);
  void setLane(uint32_t leaf);
  void tracePacket(LeafBits* bits);
  void flush(LeafBits* bits);
  void pushAll(uint64_t leaves, uint32_t word, LeafBits* bits);
  void visit(int level, uint32_t place, LeafBits* bits);
  template <class Use>
  void forProbes(const Node& node, uint64_t key, const LeafBits& bits, const Use& use) const;
  void followEdges(LeafBits* bits);
  void pushUnlike(uint32_t leaf, LeafBits* bits);
  bool confirmed(const Node& node, const LeafBits& bits) const;

  const Tracer& tracer_;
  const SampleNeighbours* neighbours_;
  const bool directions_;
  const size_t count_;
  std::vector<float> x_, y_, z_, nx_, ny_, nz_;  // samples, padded to whole words
  std::span<const FacePlace> faces_;
  std::vector<uint8_t> faceOf_;  // by leaf: number of the face that is asked, and kBehind
  std::vector<uint8_t> more_;    // by leaf: leading faces that have to see it, too, a bit each
  bool several_ = false;         // are there any such?
  std::vector<uint32_t> again_;  // leaves that one face sees and another is still to be asked about
  ShadowPacket packet_;
  uint32_t leafOf_[ShadowPacket::kSize] = {};
  int lanes_ = 0;
  uint64_t rays_ = 0;
  std::span<const LeafBits* const> nearby_;
  std::vector<Node> expected_, failed_;
  std::vector<uint64_t> traced_;        // leaves, since prepare()
  std::vector<uint32_t> fresh_, next_;  // traced leaves whose neighbours are to be looked at
};

}  // namespace lobelia::relight
