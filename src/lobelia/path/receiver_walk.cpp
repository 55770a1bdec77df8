// Eye paths that split light transport between receivers and specular connections.
//
// Every path from the camera to an emitter scatters at each vertex by a rough (R) or a sharp (S)
// lobe. Reading from the eye, S* R is the way to the first receiver. From a receiver light arrives
//  - straight from an emitter: next-event estimation and a sample of the rough lobes, weighted by
//    the power heuristic [Veach97 9.2];
//  - from a surface that scatters by R there: a virtual light, left to the gather but for what is
//    near (below);
//  - from a surface that scatters by S there: a specular connection. The receiver's one sample of
//    its rough lobes goes on from a surface that has sharp lobes, by these only, S+, to an emitter
//    or to the next R: a further receiver of the pixel, to which all this applies again.
// The three exclude one another and leave nothing out, so that the sum is the path tracer's result
// for any specular limit. At vertices of a chain, sharp lobes that are not delta are lit by
// next-event estimation too; delta lobes find emitters by hitting them.
//
// A vertex with both kinds of lobes is a receiver AND continues the chain. Branches are thinned by
// Russian roulette on their weight in the pixel, tracing (cheap) later than receivers, each of
// which costs a gather over all lights.
//
// Near surfaces. A sum over lights is a poor estimate of the light from a surface so near that only
// few of them lie there: a spike 1/d^2 from point lights, a blur from spheres. Of all light that
// leaves a surface at distance d the gather counts gatheredShare(d) only. A receiver's samples of
// its rough lobes, traced for connections anyway, have the rest: the surface that they meet becomes
// a further receiver, to which all this applies again. The two shares sum to one for any
// nearDistance, which may differ from receiver to receiver. [Davidovic10] splits light between
// global and local virtual lights by the clamp instead, and makes the local ones anew for each tile
// of the picture.
#include "lobelia/path/receiver_walk.h"

#include "lobelia/bsdf/lobe_kind.h"

namespace lobelia {
namespace {

// Weight in the pixel below which rays are traced only with proportional probability: with lossless
// lobes at every vertex at most 1 / threshold branches live at a time.
constexpr float kRayThreshold = 0.05f;
constexpr float kReceiverThreshold = 0.25f;

// Of light from p, what the receiver at the segment's start leaves to its own samples.
float shareOfSamples(const EyeSegment& segment, Vec3f p) {
  return 1 - gatheredShare(length(p - segment.origin.p), segment.nearDistance);
}

bool inSet(const Lobe& lobe, LobeSet set) {
  return (static_cast<int>(set) & static_cast<int>(lobe.sharp ? LobeSet::sharp : LobeSet::rough)) !=
         0;
}

// Can next-event estimation light any lobe of the set?
bool canEvaluate(const Bsdf& bsdf, LobeSet set) {
  for (int i = 0; i < bsdf.lobeCount; ++i)
    if (inSet(bsdf.lobes[i], set) && !isDelta(bsdf.lobes[i].type)) return true;
  return false;
}

}  // namespace

struct EyeWalk::State {
  Sampler random;
  uint32_t pixel;
  Receivers* receivers;
  EyeCounts* counts;
  EyeSample result{};
  std::vector<EyeSegment> open{};  // segments still to be followed
  std::vector<Rgb> arrived{};      // by light group, on its way to addLight(); may be empty
};

struct EyeWalk::Vertex {
  SurfacePoint at;
  Bsdf bsdf;
  Vec3f wo;
  int depth;  // edges from the camera
};

EyeWalk::EyeWalk(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                 const EyeSettings& settings, uint64_t seed, bool byGroup)
    : tracer_(tracer),
      emitters_(emitters),
      camera_(camera),
      settings_(settings),
      seed_(seed),
      byGroup_(byGroup) {}

EyeSample EyeWalk::trace(int x, int y, uint32_t pixel, Receivers* receivers,
                         EyeCounts* counts) const {
  const uint64_t stream =
      (static_cast<uint64_t>(static_cast<uint32_t>(y)) << 32) | static_cast<uint32_t>(x);
  State state{Sampler(seed_, stream, static_cast<uint32_t>(settings_.sample)), pixel, receivers,
              counts};
  if (byGroup_) {
    state.result.groups.resize(emitters_.groups().size());
    state.arrived.resize(emitters_.groups().size());
  }
  float filterWeight = 1;
  const Vec2f offset =
      sampleFilter(camera_.filter, camera_.filterRadius, state.random.next2D(), &filterWeight);
  const Vec2f film(static_cast<float>(x) + 0.5f + offset.x,
                   static_cast<float>(y) + 0.5f + offset.y);
  EyeSegment first;
  first.ray = generateRay(camera_, film, state.random.next2D());
  state.result.weight = filterWeight / static_cast<float>(settings_.sampleCount);
  first.throughput = Rgb(state.result.weight);
  if (mayEnd(1)) state.open.push_back(first);
  while (!state.open.empty()) {
    const EyeSegment next = state.open.back();
    state.open.pop_back();
    step(next, &state);
  }
  return state.result;
}

float EyeWalk::importance(const EyeSegment& segment) const {
  const Rgb t = segment.throughput;
  return std::max(std::abs(t.x), std::max(std::abs(t.y), std::abs(t.z))) * segment.etaScale *
         static_cast<float>(settings_.sampleCount);
}

void EyeWalk::step(EyeSegment segment, State* state) const {
  ++state->counts->pathRays;
  const auto hit = tracer_.intersect(segment.ray);
  if (!hit) return addEmission(segment, nullptr, emitters_.escaped(segment.ray.d), state);
  Vertex v;
  v.at = surfacePoint(emitters_.scene(), *hit);
  v.wo = -segment.ray.d;
  segment.throughput *= interiorTransmittance(emitters_.scene(), v.at, v.wo);
  v.depth = segment.depth + 1;
  if (v.at.emitter.valid()) addEmission(segment, &v.at, emitters_.emitted(v.at, v.wo), state);
  const bool first = segment.depth == 0;
  if (!mayEnd(v.depth + 1) && !first) return;
  v.bsdf = makeBsdf(emitters_.scene(), v.at, v.wo, settings_.specularLimit);
  if (first) {
    state->result.hit = true;
    state->result.albedo = albedo(v.bsdf, v.wo);
    state->result.normal = v.bsdf.frames[0].n;
    state->result.depth = hit->t;
    if (!mayEnd(v.depth + 1)) return;
  }
  if (v.depth >= kMaxEyeDepth) {
    ++state->counts->cut;
    return;
  }
  const bool sharp = hasLobes(v.bsdf, LobeSet::sharp);
  if (segment.kind == EyeSegment::Kind::receiver) {
    if (hasLobes(v.bsdf, LobeSet::rough)) receiveNear(segment, v, state);
    if (!sharp) return;  // what else comes from here is the virtual lights' part
    ++state->counts->specularConnections;
  } else if (hasLobes(v.bsdf, LobeSet::rough)) {
    receive(segment, v, state);
  }
  if (sharp) extend(segment, v, state);
}

void EyeWalk::addEmission(const EyeSegment& segment, const SurfacePoint* hit, Rgb radiance,
                          State* state) const {
  if (segment.depth == 0 && settings_.hideEmitters) return;
  float weight = 1;
  if (segment.kind == EyeSegment::Kind::receiver && settings_.directSamples == 0) {
    // Without direct samples the emitters themselves are virtual lights to receivers.
    weight = hit ? shareOfSamples(segment, hit->p) : 0;
  } else if (segment.pdf > 0) {
    weight = emissionWeight(emitters_, segment.origin, hit, segment.ray.d, segment.pdf, false);
  }
  if (radiance == Rgb(0.f) || weight == 0) return;
  if (byGroup_)
    emitters_.addByGroup(hit ? hit->emitter.index : EmitterSampler::kEscaped, segment.ray.d,
                         radiance * weight, state->arrived.data());
  addLight(segment, segment.throughput * radiance * weight, segment.throughput, state);
}

void EyeWalk::addLight(const EyeSegment& segment, Rgb light, Rgb factor, State* state) const {
  const bool finite = isFinite(light);
  if (finite) {
    (segment.direct ? state->result.direct : state->result.indirect) += light;
    if (segment.connection) state->result.specular += light;
  } else {
    ++state->counts->nonFinite;
  }
  const bool shown =
      finite && settings_.component != (segment.direct ? Component::indirect : Component::direct);
  for (size_t g = 0; g < state->arrived.size(); ++g) {
    if (shown) state->result.groups[g] += factor * state->arrived[g];
    state->arrived[g] = Rgb{};
  }
}

// Every sample is weighted as if it were the only one beside the BSDF sample: the weights still sum
// to one.
Rgb EyeWalk::nextEvent(const Vertex& v, LobeSet set, int sampleCount, State* state) const {
  if (sampleCount == 0 || !canEvaluate(v.bsdf, set)) return Rgb(0.f);
  const LightQuery query = lightQuery(v.at, v.bsdf, v.wo);
  Rgb sum(0.f);
  for (int i = 0; i < sampleCount; ++i) {
    const float uSelect = state->random.next1D();
    const Vec2f u = state->random.next2D();
    sum += sampleDirectLight(tracer_, emitters_, query, v.bsdf, v.wo, set, set, true,
                             {uSelect, u.x, u.y}, &state->counts->shadowRays,
                             [&](Rgb value, uint32_t emitter, Vec3f d) {
                               if (byGroup_)
                                 emitters_.addByGroup(emitter, d, value, state->arrived.data());
                             });
  }
  for (Rgb& value : state->arrived) value /= static_cast<float>(sampleCount);
  return sum / static_cast<float>(sampleCount);
}

void EyeWalk::receive(const EyeSegment& segment, const Vertex& v, State* state) const {
  EyeSegment next;
  next.kind = EyeSegment::Kind::receiver;
  next.direct = segment.kind == EyeSegment::Kind::eye;
  next.connection = segment.connection;
  if (settings_.nearDistance) next.nearDistance = settings_.nearDistance(v.at.p);
  // Near receivers are many: one sample of each kind will do.
  const bool isNear = segment.kind == EyeSegment::Kind::receiver;
  const int direct = isNear ? std::min(settings_.directSamples, 1) : settings_.directSamples;
  const Rgb light = nextEvent(v, LobeSet::rough, direct, state);
  addLight(next, segment.throughput * light, segment.throughput, state);
  if (mayEnd(v.depth + 2) || settings_.directSamples == 0)
    record(segment, v, next.nearDistance, state);
  // The mean of several samples: connections are few and bright. Their weights against the emitter
  // samples stay those of one sample each; they still sum to one.
  const int count = isNear ? 1 : std::max(settings_.connectionSamples, 1);
  EyeSegment from = segment;
  from.throughput /= static_cast<float>(count);
  for (int i = 0; i < count; ++i) scatter(from, v, LobeSet::rough, next, state);
}

// The share of what leaves v that the gather of the receiver at the segment's start leaves out.
void EyeWalk::receiveNear(EyeSegment segment, const Vertex& v, State* state) const {
  segment.throughput *= shareOfSamples(segment, v.at.p);
  if (segment.throughput == Rgb(0.f)) return;
  const float survival = std::min(1.f, importance(segment) / kReceiverThreshold);
  if (!(state->random.next1D() < survival)) return;
  segment.throughput /= survival;
  receive(segment, v, state);
}

void EyeWalk::record(const EyeSegment& segment, const Vertex& v, float nearDistance,
                     State* state) const {
  const float survival = std::min(1.f, importance(segment) / kReceiverThreshold);
  if (!(state->random.next1D() < survival)) return;
  ReceiverPoint r;
  r.p = v.at.p;
  r.ng = v.bsdf.ng;
  r.baseNormal = v.bsdf.baseNormal;
  r.wo = v.wo;
  r.weight = segment.throughput / survival;
  r.error = v.at.error;
  r.pixel = state->pixel;
  r.depth = static_cast<uint8_t>(v.depth);
  r.primary = segment.kind == EyeSegment::Kind::eye;
  r.nearDistance = nearDistance;
  // One for the lobes of every frame.
  std::vector<Lobe>& lobes = state->receivers->lobes;
  for (int f = 0; f < v.bsdf.frameCount; ++f) {
    r.frame = v.bsdf.frames[f];
    r.bumpAlpha2 = v.bsdf.frames[f].bumpAlpha2;
    r.firstLobe = static_cast<uint32_t>(lobes.size());
    for (int i = 0; i < v.bsdf.lobeCount; ++i) {
      const Lobe& lobe = v.bsdf.lobes[i];
      if (lobe.sharp || lobe.frame != f) continue;
      lobes.push_back(lobe);
      lobes.back().frame = 0;
    }
    r.lobeCount = static_cast<uint8_t>(lobes.size() - r.firstLobe);
    if (r.lobeCount == 0) continue;
    state->receivers->points.push_back(r);
    state->counts->nearReceivers += segment.kind == EyeSegment::Kind::receiver;
  }
}

void EyeWalk::extend(const EyeSegment& segment, const Vertex& v, State* state) const {
  EyeSegment next;
  next.kind =
      segment.kind == EyeSegment::Kind::eye ? EyeSegment::Kind::eye : EyeSegment::Kind::chain;
  next.direct = next.kind == EyeSegment::Kind::eye;
  next.connection = !next.direct;
  const Rgb light = nextEvent(v, LobeSet::sharp, 1, state);
  addLight(next, segment.throughput * light, segment.throughput, state);
  scatter(segment, v, LobeSet::sharp, next, state);
}

void EyeWalk::scatter(const EyeSegment& from, const Vertex& v, LobeSet set, EyeSegment next,
                      State* state) const {
  const float uLobe = state->random.next1D();
  const Vec2f u = state->random.next2D();
  const float uRoulette = state->random.next1D();
  const auto s = sample(v.bsdf, v.wo, uLobe, u, set);
  if (!s) return;
  next.throughput = from.throughput * s->weight;
  next.etaScale = from.etaScale * (s->transmission ? s->eta * s->eta : 1.f);
  if (!isFinite(next.throughput)) {
    ++state->counts->nonFinite;
    return;
  }
  const float survival = std::min(1.f, importance(next) / kRayThreshold);
  if (!(uRoulette < survival)) return;
  next.throughput /= survival;
  next.ray = {offsetOrigin(v.at, s->wi), s->wi};
  next.depth = v.depth;
  next.origin = lightQuery(v.at, v.bsdf, v.wo);
  next.pdf = s->delta ? 0 : s->pdf;
  state->open.push_back(next);
}

}  // namespace lobelia
