// Embree 3.13 or 4 behind one set of names; private to the room. The two differ in the type of the
// query context and in how flags are passed.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <type_traits>

#include "lobelia/trace/tracer.h"

namespace lobelia::embree {

#if RTC_VERSION_MAJOR >= 4
using BaseContext = RTCRayQueryContext;
#else
using BaseContext = RTCIntersectContext;
#endif

// What the filter functions get to see of a query: the rays in world space (inside instances Embree
// hands out transformed ones, whose bits differ between single rays and packets). One of the two.
struct QueryContext {
  BaseContext base;
  const Ray* ray = nullptr;
  const ShadowPacket* packet = nullptr;  // the lane is the ray's id
};

#if RTC_VERSION_MAJOR >= 4
inline RTCRayQueryFlags queryFlags(bool coherent) {
  return coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
inline void intersect1(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  rtcInitRayQueryContext(&context.base);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context.base;
  rtcIntersect1(scene, &ray, &arguments);
}
inline void occluded1(RTCScene scene, QueryContext& context, RTCRay& ray) {
  rtcInitRayQueryContext(&context.base);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context.base;
  rtcOccluded1(scene, &ray, &arguments);
}
template <class Rays>
void occludedPacket(const int* valid, RTCScene scene, QueryContext& context, bool coherent,
                    Rays& rays) {
  rtcInitRayQueryContext(&context.base);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = queryFlags(coherent);
  arguments.context = &context.base;
  if constexpr (std::is_same_v<Rays, RTCRay16>) {
    rtcOccluded16(valid, scene, &rays, &arguments);
  } else {
    rtcOccluded8(valid, scene, &rays, &arguments);
  }
}
template <class Rays>
void intersectPacket(const int* valid, RTCScene scene, QueryContext& context, bool coherent,
                     Rays& rays) {
  rtcInitRayQueryContext(&context.base);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = queryFlags(coherent);
  arguments.context = &context.base;
  if constexpr (std::is_same_v<Rays, RTCRayHit16>) {
    rtcIntersect16(valid, scene, &rays, &arguments);
  } else {
    rtcIntersect8(valid, scene, &rays, &arguments);
  }
}
#else
inline void intersect1(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  rtcInitIntersectContext(&context.base);
  rtcIntersect1(scene, &context.base, &ray);
}
inline void occluded1(RTCScene scene, QueryContext& context, RTCRay& ray) {
  rtcInitIntersectContext(&context.base);
  rtcOccluded1(scene, &context.base, &ray);
}
template <class Rays>
void occludedPacket(const int* valid, RTCScene scene, QueryContext& context, bool coherent,
                    Rays& rays) {
  rtcInitIntersectContext(&context.base);
  if (coherent) context.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  if constexpr (std::is_same_v<Rays, RTCRay16>) {
    rtcOccluded16(valid, scene, &context.base, &rays);
  } else {
    rtcOccluded8(valid, scene, &context.base, &rays);
  }
}
template <class Rays>
void intersectPacket(const int* valid, RTCScene scene, QueryContext& context, bool coherent,
                     Rays& rays) {
  rtcInitIntersectContext(&context.base);
  if (coherent) context.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  if constexpr (std::is_same_v<Rays, RTCRayHit16>) {
    rtcIntersect16(valid, scene, &context.base, &rays);
  } else {
    rtcIntersect8(valid, scene, &context.base, &rays);
  }
}
#endif

}  // namespace lobelia::embree
