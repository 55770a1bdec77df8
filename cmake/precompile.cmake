# Precompiled headers of the libraries that nearly every file includes: they take a third to a half
# of a build's time. They hide a missing #include, so the preset ci builds without them and
# asan-ubsan with them; none of our own headers is among them.
#
# lobelia_precompile(TARGET FAMILY HEADERS...): the first target of a family makes the headers, the
# others use them, and must be compiled alike.
function(lobelia_precompile target family)
  if(NOT LOBELIA_PRECOMPILE)
    return()
  endif()
  get_property(maker GLOBAL PROPERTY lobelia_precompiled_${family})
  if(maker)
    target_precompile_headers(${target} REUSE_FROM ${maker})
    return()
  endif()
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <atomic> <bit> <charconv> <cmath>
    <cstring> <filesystem> <functional> <limits> <map> <memory> <optional> <random> <set> <span>
    <sstream> <string> <vector> <fmt/format.h> <fmt/ranges.h> ${ARGN})
  set_property(GLOBAL PROPERTY lobelia_precompiled_${family} ${target})
endfunction()
