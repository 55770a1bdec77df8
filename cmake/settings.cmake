# Compiler settings of every target: warnings, sanitizers, the compiler cache.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  if(LOBELIA_PRECOMPILE)  # what ccache asks for before it takes files with precompiled headers
    list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros)
  endif()
endif()

add_library(lobelia_settings INTERFACE)
# -ffp-contract=off: one source compiled for several SIMD targets and for scalar code must not
# differ by where the compiler happens to fuse.
target_compile_options(lobelia_settings INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -ffp-contract=off -fno-math-errno)
if(LOBELIA_WERROR)
  target_compile_options(lobelia_settings INTERFACE -Werror)
endif()
if(LOBELIA_SANITIZE)
  target_compile_options(lobelia_settings INTERFACE
    -fsanitize=${LOBELIA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # Highway's baseline for clang emulates registers by arrays, whose loops with their checks take
  # nine tenths of the kernels' compilation; GCC's, which is released, is one lane of scalar code.
  target_compile_definitions(lobelia_settings INTERFACE HWY_BROKEN_EMU128=1)
  target_link_options(lobelia_settings INTERFACE -fsanitize=${LOBELIA_SANITIZE})
endif()
install(TARGETS lobelia_settings EXPORT lobeliaTargets)
