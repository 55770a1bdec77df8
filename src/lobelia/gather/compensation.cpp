// Compensation of the clamp and of missing lobes by path tracing [Kollig04 section 3; Hasan09
// section 2, figure 2c].
//
// Receiver x, by its lobes F(wi) (with the cosine, max: their largest channel), gathers
//     sum over lights y of  I s(w) / d^2  F(-w)  k(x, y),     k = min(1, c d^2 / (s(w) max F)),
// where a light's intensity I is the power of a particle times the amplitude of a lobe s of the
// light: [ny.w]+ of a diffuse light, exp(sharpness (axis.w - 1)) of a Gaussian (gather_all.cpp). In
// expectation over particles, which arrive at y from wi' with the flux L(y, wi') |ny.wi'| dA dwi',
// and with dA = d^2 dw / |ny.w| this is
//     integral over w of  F(-w)  integral over wi' of  L(y, wi') g(w, wi'),
//     g = |ny.wi'| / |ny.w|  sum over lobes j of  A_j(wi') s_j(w) k_j(x, y).
// One Gaussian is drawn per vertex, its amplitude divided by the probability; as the intensity is
// outside the clamp, the sum over all of them is the expectation. The truth has the rough lobes
// f(w, wi') |ns.wi'| in the place of g (sharp ones: path/receiver_walk.cpp). Compensation is the
// difference, exactly: a sample of F from x finds y; from there the path goes on to L by
//     h(w, wi') = f(w, wi') |ns.wi'| T - g(w, wi'),
// T what a medium between x and y lets through, which the gather does not look at. L is what the
// path tracer finds, with next-event estimation at y by h and from then on by whole BSDFs.
//
// For diffuse surfaces h is f (1 - k), the form of the paper. The difference contains, for `vpl`,
// all that glossy lobes at y send to x, and for `glossy` the error of the Gaussian fits, so that
// the sum is unbiased for both whatever the fits are, and with any clamp, or none.
//
// Deviations: the paper recurses, clamping and compensating at y again; the path tracer's radiance
// at y is unbiased all the same and needs no lights. It bounds the ray's length, which glossy lobes
// (h reaches everywhere) do not allow.
#include "lobelia/gather/compensation.h"

#include "lobelia/bsdf/gaussians.h"
#include "lobelia/lights/particle_walk.h"
#include "lobelia/path/path_walk.h"

namespace lobelia {
namespace {

constexpr uint64_t kStream = 0x636f6d70656e73ull;
// Share of directions at y that are drawn by the cosine: g has energy where f's sampling has none.
constexpr float kCosineShare = 0.1f;
// Missing share of f below which it is looked at with proportional probability.
constexpr float kMissing = 0.02f;
// Throughput below which paths go on from y with proportional probability.
constexpr float kRouletteThreshold = 0.25f;

// The surface that a receiver's ray has met.
struct Vertex {
  SurfacePoint at;
  Bsdf bsdf;
  Vec3f w;            // towards the receiver
  Rgb transmittance;  // between the two
  float limit;        // largest s that the clamp lets through: c d^2 / max F
  LightQuery query;
  bool bothSides;  // may light from the other side be scattered to w?
};

class Compensation {
 public:
  Compensation(const Tracer& tracer, const EmitterSampler& emitters, const Receivers& receivers,
               const CompensationSettings& settings, uint64_t seed)
      : tracer_(tracer),
        emitters_(emitters),
        receivers_(receivers),
        settings_(settings),
        seed_(hashCombine(seed, kStream)),
        path_(pathSettings(settings)),
        walk_(tracer, emitters, path_, false) {}

  Rgb at(const ReceiverPoint& point, uint64_t stream, Rgb* groups,
         ReceiverRayCounts* counts) const {
    const int edges = point.depth + 2;  // of the shortest path: over y to an emitter
    if (settings_.maxDepth >= 0 && edges > settings_.maxDepth) return {};
    PathRandom random(seed_, stream, static_cast<uint32_t>(settings_.rays.sample));
    const Bsdf bsdf = receiverBsdf(receivers_, point);
    const float uLobe = random.next1D();
    const auto s = sample(bsdf, point.wo, uLobe, random.next2D(), LobeSet::rough);
    if (!s) return {};
    ++counts->pathRays;
    const Ray ray{offsetOrigin(point.p, point.ng, point.error, s->wi), s->wi};
    const auto hit = tracer_.intersect(ray);
    if (!hit) return {};
    const float largest = maxComponent(s->weight) * s->pdf;
    const auto vertex = vertexOf(*hit, point.p, s->wi, largest);
    if (!vertex) return {};
    return direct(*vertex, s->weight, random, groups, counts) +
           further(*vertex, s->weight, edges, random, groups, counts);
  }

 private:
  static PathSettings pathSettings(const CompensationSettings& settings) {
    PathSettings out;
    out.maxDepth = settings.maxDepth;
    out.specularLimit = settings.specularLimit;
    out.component = Component::indirect;
    return out;
  }

  std::optional<Vertex> vertexOf(const Hit& hit, Vec3f from, Vec3f d, float largest) const {
    Vertex v;
    v.at = surfacePoint(emitters_.scene(), hit);
    v.w = -d;
    v.bsdf = makeBsdf(emitters_.scene(), v.at, v.w, settings_.specularLimit);
    if (!hasLobes(v.bsdf, LobeSet::rough)) return {};
    v.transmittance = interiorTransmittance(emitters_.scene(), v.at, v.w);
    v.limit = settings_.clamp > 0 ? settings_.clamp * lengthSquared(v.at.p - from) / largest
                                  : std::numeric_limits<float>::infinity();
    if (complete(v)) return {};
    v.query = lightQuery(v.at, v.bsdf, v.w);
    // g goes by the geometric normal: where the two disagree no side may be left out.
    if (dot(v.query.n, v.w) * dot(v.at.ng, v.w) * dot(v.query.n, v.at.ng) <= 0) v.query.n = {};
    v.bothSides = false;
    for (int i = 0; i < v.bsdf.lobeCount; ++i)
      v.bothSides |= !v.bsdf.lobes[i].sharp && isTransmission(v.bsdf.lobes[i].type);
    return v;
  }

  // Is h zero for all directions? Of plain diffuse, flat surfaces that are not clamped.
  static bool complete(const Vertex& v) {
    if (v.limit < 1 || v.transmittance != Rgb(1.f)) return false;
    for (int i = 0; i < v.bsdf.lobeCount; ++i)
      if (!v.bsdf.lobes[i].sharp && v.bsdf.lobes[i].type != LobeType::lambert) return false;
    return v.bsdf.frameCount == 1 && dot(v.bsdf.frames[0].n, v.at.ng) > 1 - 1e-6f;
  }

  // g: what lights at v send to the receiver of the light that arrives from wi.
  Rgb sentByLights(const Vertex& v, Vec3f wi) const {
    const Bsdf bsdf = makeBsdf(emitters_.scene(), v.at, wi, settings_.specularLimit);
    if (!hasLobes(bsdf, LobeSet::rough)) return {};
    const float cosine = dot(v.w, bsdf.ng), arriving = dot(wi, bsdf.ng);
    if (cosine == 0) return {};
    const LobeExpansion lobes = expand(bsdf, wi, settings_.gaussiansPerLobe);
    Rgb sum = (cosine * arriving > 0 ? lobes.diffuse : lobes.diffuseTransmitted) * kInvPi *
              std::min(std::abs(cosine), v.limit);
    for (int i = 0; i < lobes.count && settings_.glossy; ++i) {
      const GaussianLobe& lobe = lobes.gaussians[static_cast<size_t>(i)];
      const Vec3f n = dot(bsdf.ng, lobe.normal) > 0 ? bsdf.ng : -bsdf.ng;
      if (!(dot(n, v.w) > 0)) continue;
      const float s = std::exp(-0.5f * lobe.sharpness * lengthSquared(lobe.axis - v.w));
      sum += lobe.amplitude * (geometricRatio(lobe, n) * std::min(s, v.limit));
    }
    return sum * std::abs(arriving / cosine);
  }

  // h. Where nearly nothing of f is missing it is zero but for a share of the cases (survival, of
  // u): most of a diffuse scene, where h would be rounding.
  Rgb missing(const Vertex& v, Vec3f wi, float u) const {
    const Rgb whole = evaluate(v.bsdf, v.w, wi, LobeSet::rough) * v.transmittance;
    const Rgb h = whole - sentByLights(v, wi);
    const float size = maxComponent(absolute(h));
    if (size == 0) return {};
    const float survival = std::min(1.f, size / (kMissing * maxComponent(whole)));
    return u < survival ? h / survival : Rgb{};
  }
  static Rgb absolute(Rgb c) { return {std::abs(c.x), std::abs(c.y), std::abs(c.z)}; }

  float cosinePdf(const Vertex& v, Vec3f wi) const {
    const float c = dot(wi, v.at.ng);
    if (v.bothSides) return 0.5f * kInvPi * std::abs(c);
    return dot(v.w, v.at.ng) * c > 0 ? kInvPi * std::abs(c) : 0.f;
  }
  float density(const Vertex& v, Vec3f wi) const {
    return kCosineShare * cosinePdf(v, wi) +
           (1 - kCosineShare) * pdf(v.bsdf, v.w, wi, LobeSet::rough);
  }

  Vec3f cosineDirection(const Vertex& v, float uSide, Vec2f u) const {
    const Vec3f local = sampleHemisphereCosine(u);
    const bool other = v.bothSides && uSide < 0.5f;
    const Vec3f n = (dot(v.w, v.at.ng) < 0) != other ? -v.at.ng : v.at.ng;
    return frameFromNormal(n).toWorld(local);
  }

  // Emitters seen from v.
  Rgb direct(const Vertex& v, Rgb throughput, PathRandom& random, Rgb* groups,
             ReceiverRayCounts* counts) const {
    const float select = random.next1D(), uMissing = random.next1D();
    const Vec2f place = random.next2D();
    const auto light = emitters_.sampleDirection(v.query.p, v.query.n, {select, place.x, place.y});
    if (!light) return {};
    Rgb value = throughput * missing(v, light->wi, uMissing) * light->weight;
    if (!light->delta) value *= powerHeuristic(light->pdf, density(v, light->wi));
    if (value == Rgb{}) return {};
    ++counts->shadowRays;
    const Ray ray = shadowRay(v.query, *light);
    if (tracer_.occluded(ray)) return {};
    if (groups != nullptr) emitters_.addByGroup(light->emitter, ray.d, value, groups);
    return value;
  }

  // All other light that reaches v, by the path tracer. depth: of the vertex after v.
  Rgb further(const Vertex& v, Rgb throughput, int depth, PathRandom& random, Rgb* groups,
              ReceiverRayCounts* counts) const {
    const float uChoice = random.next1D(), uLobe = random.next1D(), uRoulette = random.next1D();
    const float uMissing = random.next1D();
    const Vec2f u = random.next2D();
    Vec3f wi;
    float eta = 1;
    if (uChoice < kCosineShare) {
      wi = cosineDirection(v, uLobe, u);
    } else {
      const auto s = sample(v.bsdf, v.w, uLobe, u, LobeSet::rough);
      if (!s) return {};
      wi = s->wi, eta = s->eta;
    }
    const float p = density(v, wi);
    if (!(p > 0)) return {};
    throughput *= missing(v, wi, uMissing) / p;
    const float survival = std::min(1.f, maxComponent(absolute(throughput)) / kRouletteThreshold);
    if (!(uRoulette < survival)) return {};
    throughput /= survival;

    PathState path(Ray{offsetOrigin(v.at, wi), wi}, random, 0);
    path.chain = path.metDirect = {};
    path.indirect = path.metIndirect = throughput;
    path.from = v.query;
    path.pdfFrom = p, path.deltaFrom = false;
    path.eta = eta;
    path.depth = depth;
    if (groups != nullptr) path.groups = {&emitters_, Component::indirect, groups};
    PathCounts walked;
    walk_.trace(std::span(&path, 1), walked);
    counts->pathRays += walked.pathRays, counts->shadowRays += walked.shadowRays;
    counts->nonFinite += walked.nonFinite;
    return path.result.indirect;
  }

  const Tracer& tracer_;
  const EmitterSampler& emitters_;
  const Receivers& receivers_;
  const CompensationSettings& settings_;
  const uint64_t seed_;
  const PathSettings path_;
  const PathWalk<Tracer> walk_;
};

}  // namespace

void compensate(const Tracer& tracer, const EmitterSampler& emitters, const Receivers& receivers,
                const CompensationSettings& settings, std::span<Rgb> radiance, Context& context,
                GatherParts* parts) {
  const Compensation compensation(tracer, emitters, receivers, settings, context.seed);
  lightReceivers(
      receivers, settings.rays,
      [&](const ReceiverPoint& point, uint64_t stream, Rgb* groups, ReceiverRayCounts* counts) {
        return compensation.at(point, stream, groups, counts);
      },
      "compensate", radiance, context, parts);
}

}  // namespace lobelia
