# Installs the libraries, their public headers and what find_package(emscape) reads.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/emscape")

install(DIRECTORY include/emscape DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(EXPORT emscape NAMESPACE emscape:: FILE emscapeTargets.cmake DESTINATION "${config_dir}")

configure_package_config_file(cmake/emscapeConfig.cmake.in "${PROJECT_BINARY_DIR}/emscapeConfig.cmake"
  INSTALL_DESTINATION "${config_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/emscapeConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES
    "${PROJECT_BINARY_DIR}/emscapeConfig.cmake"
    "${PROJECT_BINARY_DIR}/emscapeConfigVersion.cmake"
    cmake/EmscapeDependencies.cmake
  DESTINATION "${config_dir}")
