// Classes of lights as constants of templates.
#if defined(LOBELIA_GATHER_BY_CLASS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_BY_CLASS_INL_H_
#undef LOBELIA_GATHER_BY_CLASS_INL_H_
#else
#define LOBELIA_GATHER_BY_CLASS_INL_H_
#endif

#include <type_traits>

#include "lobelia/base/core-inl.h"
#include "lobelia/gather/light_block.h"

LOBELIA_CORE_BEGIN

// Calls f with an object of which decltype()::value is the class.
template <class F>
auto byClass(::lobelia::gather::LightClass lightClass, const F& f) {
  using enum ::lobelia::gather::LightClass;
  switch (lightClass) {
    case omni:
      return f(std::integral_constant<::lobelia::gather::LightClass, omni>());
    case directional:
      return f(std::integral_constant<::lobelia::gather::LightClass, directional>());
    case diffuse:
      return f(std::integral_constant<::lobelia::gather::LightClass, diffuse>());
    case spherical:
      return f(std::integral_constant<::lobelia::gather::LightClass, spherical>());
    case gaussian:
      return f(std::integral_constant<::lobelia::gather::LightClass, gaussian>());
    case glossy:
      break;
  }
  return f(std::integral_constant<::lobelia::gather::LightClass, glossy>());
}

LOBELIA_CORE_END

#endif  // per-target include guard
