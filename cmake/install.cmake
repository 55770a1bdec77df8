# Installation: headers, libraries and an exported package `find_package(lobelia)`.
include(CMakePackageConfigHelpers)
configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/lobeliaConfig.cmake.in
  ${CMAKE_BINARY_DIR}/lobeliaConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lobelia)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/lobeliaConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(EXPORT lobeliaTargets NAMESPACE lobelia:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lobelia)
install(FILES ${CMAKE_BINARY_DIR}/lobeliaConfig.cmake ${CMAKE_BINARY_DIR}/lobeliaConfigVersion.cmake
  ${CMAKE_SOURCE_DIR}/cmake/dependencies.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lobelia)

# Man pages and shell completion, which the program writes about itself.
set(documents ${CMAKE_BINARY_DIR}/documents)
add_custom_command(OUTPUT ${documents}.stamp
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${documents}
  COMMAND ${CMAKE_COMMAND} -E env ASAN_OPTIONS=detect_leaks=0 $<TARGET_FILE:lobelia> docs files ${documents}
  COMMAND ${CMAKE_COMMAND} -E touch ${documents}.stamp
  DEPENDS lobelia COMMENT "Writing man pages and shell completion" VERBATIM)
add_custom_target(lobelia_documents ALL DEPENDS ${documents}.stamp)
# Packagers may leave the target out; then there is nothing to install.
install(DIRECTORY ${documents}/ DESTINATION ${CMAKE_INSTALL_DATADIR} OPTIONAL)
