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
