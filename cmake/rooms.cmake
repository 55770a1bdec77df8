# One target per room (docs/architecture.md): lobelia_room(NAME ROOMS ... LIBRARIES ...).
# ROOMS names the rooms that this one may include; scripts/check-rooms proves that none is
# included that is not named here or reached through one that is. FOLDERS: folders within the room.
# PRECOMPILE: what else is worth precompiling for it (precompile.cmake).
function(lobelia_room name)
  cmake_parse_arguments(ROOM "" "" "ROOMS;FOLDERS;LIBRARIES;PRIVATE;PRECOMPILE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  foreach(folder IN LISTS ROOM_FOLDERS)
    file(GLOB more CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/${folder}/*.cpp)
    list(APPEND sources ${more})
  endforeach()
  if(NOT sources)
    return()
  endif()
  add_library(lobelia_${name} STATIC ${sources})
  add_library(lobelia::${name} ALIAS lobelia_${name})
  set_target_properties(lobelia_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(lobelia_${name} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  list(TRANSFORM ROOM_ROOMS PREPEND lobelia_)
  target_link_libraries(lobelia_${name}
    PUBLIC ${ROOM_ROOMS} ${ROOM_LIBRARIES}
    PRIVATE $<BUILD_INTERFACE:lobelia_settings> ${ROOM_PRIVATE})
  if(ROOM_PRECOMPILE)
    lobelia_precompile(lobelia_${name} ${name} ${ROOM_PRECOMPILE})
  else()
    lobelia_precompile(lobelia_${name} rooms)
  endif()
  install(TARGETS lobelia_${name} EXPORT lobeliaTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${name} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/lobelia FILES_MATCHING PATTERN "*.h")
endfunction()
