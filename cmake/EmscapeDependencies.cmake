# The packages that the libraries link; shared by the build and by the installed find_package(emscape).
list(APPEND CMAKE_MODULE_PATH /usr/share/cmake/geographiclib)  # where Debian keeps its find module
set(EMSCAPE_DEPENDENCIES PkgConfig TBB GeographicLib pugixml yaml-cpp nlohmann_json fmt PNG ZLIB)

# emscape_find_dependencies(COMMAND ...): find_package REQUIRED or find_dependency, for each package.
macro(emscape_find_dependencies command)
  set(_emscape_shared_libs "${BUILD_SHARED_LIBS}")
  set(_emscape_log_level "${CMAKE_MESSAGE_LOG_LEVEL}")
  set(CMAKE_MESSAGE_LOG_LEVEL WARNING)  # Debian's find modules print irrelevant messages
  foreach(_emscape_package IN LISTS EMSCAPE_DEPENDENCIES)
    cmake_language(CALL ${command} ${_emscape_package} ${ARGN})
  endforeach()
  set(CMAKE_MESSAGE_LOG_LEVEL "${_emscape_log_level}")
  set(BUILD_SHARED_LIBS "${_emscape_shared_libs}")  # Debian's FindOpenVDB sets it
  pkg_check_modules(HWY REQUIRED QUIET IMPORTED_TARGET libhwy)
  pkg_check_modules(PANGOCAIRO REQUIRED QUIET IMPORTED_TARGET pangocairo cairo-svg)
  pkg_check_modules(EPOXY QUIET IMPORTED_TARGET epoxy)
endmacro()
