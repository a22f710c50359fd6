# Debian packages, by the target emscape_packages (scripts/package) into packages/: `emscape` with the programs, `libemscape-dev`
# with the libraries.
set(EMSCAPE_PACKAGE_MAINTAINER "Emscape developers <maintainers@emscape.invalid>" CACHE STRING "Maintainer of the Debian packages")
get_property(library_packages GLOBAL PROPERTY EMSCAPE_LIBRARY_PACKAGES)
get_property(contained_packages GLOBAL PROPERTY EMSCAPE_CONTAINED_PACKAGES)

# The copyright: ours, and that of each included component.
set(EMSCAPE_CONTAINED_COPYRIGHTS "")
foreach(package IN LISTS contained_packages)
  set(file "/usr/share/doc/${package}/copyright")
  if(EXISTS "${file}")
    file(READ "${file}" text)
    string(APPEND EMSCAPE_CONTAINED_COPYRIGHTS "\n\n======== ${package} ========\n${text}")
  endif()
endforeach()
configure_file(cmake/package/copyright.in "${PROJECT_BINARY_DIR}/package/copyright" @ONLY)

# The date of a version is taken from its heading in the changelog.
file(STRINGS CHANGELOG.md heading REGEX "^## \\[${PROJECT_VERSION}\\] - " LIMIT_COUNT 1)
string(REGEX REPLACE "^.* - " "" date "${heading}")
if(date STREQUAL "")
  set(date 1970-01-01)  # not released
endif()
execute_process(COMMAND date --utc --rfc-email --date "${date}" OUTPUT_VARIABLE EMSCAPE_PACKAGE_DATE OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET)
foreach(row program:emscape development:libemscape-dev)
  string(REPLACE ":" ";" row "${row}")
  list(GET row 0 component)
  list(GET row 1 EMSCAPE_PACKAGE)
  set(folder "${PROJECT_BINARY_DIR}/package/${component}")
  configure_file(cmake/package/changelog.Debian.in "${folder}/changelog.Debian" @ONLY)
  install(FILES "${folder}/changelog.Debian" "${PROJECT_BINARY_DIR}/package/copyright"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${EMSCAPE_PACKAGE}" COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME emscape)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "electromagnetic environment of a battlefield")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX "${PROJECT_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/package/compress_staged.cmake")
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${EMSCAPE_PACKAGE_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME emscape)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# In addition to the libraries that it is linked with: GDAL, which is loaded, the EGM96 geoid, and the font of labels and of the window.
execute_process(COMMAND dpkg-query --search "*/${EMSCAPE_GDAL_FILE}" OUTPUT_VARIABLE gdal_package ERROR_QUIET)
string(REGEX REPLACE ":.*" "" gdal_package "${gdal_package}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${gdal_package}, proj-data, fonts-dejavu-core")
# Videos; OpenGL for the window, which loads it when it starts.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "ffmpeg, libgl1, libegl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "fonts-noto-core, fonts-noto-cjk")  # names in more scripts
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "Computes the field of radars, transmitters and jammers on moving platforms over
real terrain as a volume that changes with time, and draws it: pictures, videos,
a window, maps of coverage, links, what-if studies.")

list(JOIN library_packages ", " library_packages)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libemscape-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "emscape (= ${PROJECT_VERSION}-1), pkg-config, ${library_packages}")  # emscape_vdb.so
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Static libraries and C++17 headers of Emscape, and what find_package(emscape) of
CMake reads.")
include(CPack)

add_custom_target(emscape_packages
  COMMAND "${CMAKE_CPACK_COMMAND}" --config "${PROJECT_BINARY_DIR}/CPackConfig.cmake"
  DEPENDS emscape emscape_bench emscape_share $<TARGET_NAME_IF_EXISTS:emscape_view>
  WORKING_DIRECTORY "${PROJECT_BINARY_DIR}" USES_TERMINAL)
