#include "lobelia/gather/rich_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/base/error.h"
#include "lobelia/base/parallel.h"
#include "lobelia/gather/light_forest.h"

namespace lobelia::gather {
namespace {

void requireMemory(const RichSettings& settings, size_t places) {
  const uint64_t each = RichRadiance::bytesPerLight(settings.form, settings.texels, settings.lobes);
  if (each * places <= settings.memory) return;
  const auto mebibytes = [](uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); };
  const bool cube = settings.form == RichForm::cube;
  throw UsageError(fmt::format(
      "--memory {:.3g} MiB is too little for {} Rich-VPLs of {} bytes each, which take {:.0f} MiB; "
      "allow more, or use fewer --richvpl-lights or --richvpl-{}{}",
      mebibytes(settings.memory), places, each, std::ceil(mebibytes(each * places)),
      cube ? "texels" : "lobes", cube ? ", or --richvpl-radiance vmf" : ""));
}

const std::vector<uint32_t>& depthEnds(const VirtualLights& lights, LightClass lightClass) {
  return lightClass == LightClass::glossy ? lights.glossyDepthEnds : lights.diffuseDepthEnds;
}

size_t depthOf(const VirtualLights& lights, const ChosenLight& light) {
  const std::vector<uint32_t>& ends = depthEnds(lights, light.lightClass);
  return static_cast<size_t>(std::upper_bound(ends.begin(), ends.end(), light.index) -
                             ends.begin());
}

}  // namespace

// What a place stands for, summed up.
class RichLights::Builder {
 public:
  Builder(const VirtualLights& lights, const LightNumbers& numbers, const RichPlaces& places)
      : lights_(lights), numbers_(numbers), places_(places), first_(places.light.size() + 1, 0) {
    for (const uint32_t place : places.placeOf)
      if (place != RichPlaces::kNone) ++first_[place + 1];
    for (size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    members_.resize(first_.back());
    std::vector<size_t> next(first_.begin(), first_.end() - 1);
    for (size_t i = 0; i < places.placeOf.size(); ++i)
      if (const uint32_t place = places.placeOf[i]; place != RichPlaces::kNone)
        members_[next[place]++] = static_cast<uint32_t>(i);
    depths_ = 1 + std::max(lights.diffuseDepthEnds.size(), lights.glossyDepthEnds.size());
    shares_.resize(depths_ * places.light.size());
  }

  DiffuseLight build(size_t place, float spread, RichRadiance* radiance) {
    const ChosenLight at = numbers_.at(places_.light[place]);
    const LightSite site = siteOf(lights_, at);
    DiffuseLight out;
    out.p = site.p;
    out.normal = encodeOctahedral(site.n);
    out.tag = uint32_t{groupOf(lights_, at.lightClass, at.index)} << 8;
    Rgb cosine;
    std::vector<RichLobe> lobes;
    std::vector<Vec3f> normals;
    double power = 0, squares = 0;
    float* shares = &shares_[place * depths_];
    for (size_t m = first_[place]; m < first_[place + 1]; ++m) {
      const ChosenLight light = numbers_.at(members_[m]);
      const LightSite own = siteOf(lights_, light);
      if (light.lightClass == LightClass::diffuse) {
        cosine += lights_.diffuse[light.index].intensity;
      } else {
        const GlossyLight& glossy = lights_.glossy[light.index];
        lobes.push_back({glossy.axis, glossy.sharpness, glossy.intensity});
        normals.push_back(own.n);
      }
      const float weight = luminance(lightPower(lights_, light.lightClass, light.index));
      power += double{weight};
      squares += double{weight} * double{lengthSquared(own.p - site.p)};
      shares[std::min(depthOf(lights_, light), depths_ - 1)] += weight;
    }
    for (size_t d = 1; d < depths_; ++d) shares[d] += shares[d - 1];
    for (size_t d = 0; d < depths_; ++d)
      shares[d] = power > 0 ? shares[d] / static_cast<float>(power) : 1.f;
    const float least = power > 0 ? spread * static_cast<float>(squares / power) : 0.f;
    radiance->set(place, decodeOctahedral(out.normal), cosine, lobes, normals, least);
    out.intensity = Rgb(radiance->light(place).peak);
    return out;
  }

  // Once all places are built.
  void limitDepth(int maxDepth, RichRadiance* radiance) {
    radiance->limitDepth(maxDepth, depths_, std::move(shares_));
  }

 private:
  const VirtualLights& lights_;
  const LightNumbers& numbers_;
  const RichPlaces& places_;
  std::vector<size_t> first_;      // of a place's in members_
  std::vector<uint32_t> members_;  // numbers of lights, place by place
  size_t depths_ = 0;
  std::vector<float> shares_;  // RichRadiance::limitDepth()
};

RichLights::RichLights(const Tracer& tracer, const Receivers& sample, const VirtualLights& lights,
                       const RichSettings& settings, Context& context)
    : tracer_(tracer), settings_(settings) {
  const LightNumbers numbers(lights, settings.gather);
  std::vector<ChosenLight> asTheyAre;
  for (size_t i = 0; i < numbers.count(); ++i) {
    const ChosenLight light = numbers.at(i);
    if (light.lightClass != LightClass::diffuse && light.lightClass != LightClass::glossy)
      asTheyAre.push_back(light);
  }
  lights_ = chooseLights(lights, asTheyAre);
  RichPlaces places;
  if (const size_t joined = numbers.count() - asTheyAre.size(); joined > 0) {
    requireMemory(settings, std::min(joined, settings.lights));
    RichPlaceSettings placeSettings{settings.gather, settings.lights, settings.seed};
    places = chooseRichPlaces(tracer, sample, lights, numbers, placeSettings, context);
  }
  const StageTimer timer(context, "trees");
  const size_t count = places.light.size();
  radiance_ = std::make_unique<RichRadiance>(settings.form, count, settings.texels, settings.lobes);
  Builder builder(lights, numbers, places);
  lights_.diffuse.resize(count);
  lights_.diffuseDepthEnds.clear();  // all of them for every receiver; RichRadiance::share()
  parallelFor(count, 1, [&](size_t i) {
    if (!context.cancelled())
      lights_.diffuse[i] = builder.build(i, settings.spread, radiance_.get());
  });
  if (settings.gather.maxDepth >= 0) builder.limitDepth(settings.gather.maxDepth, radiance_.get());
  const uint64_t each = RichRadiance::bytesPerLight(settings.form, settings.texels, settings.lobes);
  context.statistics.addCount("rich_lights", count);
  context.statistics.addCount("rich_bytes", count * each);
}

void RichLights::gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
                        Context& context, GatherParts* parts) const {
  GatherSettings settings = settings_.gather;
  settings.onlyPixel = onlyPixel;
  settings.rich = radiance_.get();
  gatherAll(tracer_, receivers, lights_, settings, radiance, context, parts);
}

}  // namespace lobelia::gather
