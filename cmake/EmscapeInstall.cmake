# Installs the programs with their data, manual pages and documentation (component program), and the libraries with their public
# headers and the files that find_package(emscape) reads (component development). What was not built is left out (OPTIONAL): after
# `cmake --build . --target emscape`, the manual pages and the completion.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(share "${PROJECT_BINARY_DIR}/share")
install(DIRECTORY scenarios DESTINATION "${CMAKE_INSTALL_DATADIR}/emscape" COMPONENT program PATTERN "*.py" EXCLUDE)
install(DIRECTORY "${share}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT program OPTIONAL)
install(FILES "${share}/completion/emscape" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT program OPTIONAL)
install(FILES "${share}/completion/_emscape" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions"  # where Debian's zsh looks
  COMPONENT program OPTIONAL)
# The documentation, and what it links to, at the same relative places as in the source folder.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE LICENSE.military-symbol DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
install(FILES "${share}/emscape.cdx.json" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program OPTIONAL)
install(DIRECTORY docs DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" PATTERN "*.gif" PATTERN "*.ipynb" PATTERN ".*" EXCLUDE)
install(DIRECTORY examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program
  FILES_MATCHING PATTERN "*.cpp" PATTERN "*.py" PATTERN CMakeLists.txt)
install(FILES tests/data/README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}/tests/data" COMPONENT program)
file(RELATIVE_PATH scenarios_from_doc "${CMAKE_INSTALL_FULL_DOCDIR}" "${CMAKE_INSTALL_FULL_DATADIR}/emscape/scenarios")
file(CREATE_LINK "${scenarios_from_doc}" "${PROJECT_BINARY_DIR}/scenarios" SYMBOLIC)
install(FILES "${PROJECT_BINARY_DIR}/scenarios" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)

set(config_dir "${CMAKE_INSTALL_LIBDIR}/cmake/emscape")

install(DIRECTORY include/emscape DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development)
install(EXPORT emscape NAMESPACE emscape:: FILE emscapeTargets.cmake DESTINATION "${config_dir}" COMPONENT development)

configure_package_config_file(cmake/emscapeConfig.cmake.in "${PROJECT_BINARY_DIR}/emscapeConfig.cmake"
  INSTALL_DESTINATION "${config_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/emscapeConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES
    "${PROJECT_BINARY_DIR}/emscapeConfig.cmake"
    "${PROJECT_BINARY_DIR}/emscapeConfigVersion.cmake"
    cmake/EmscapeDependencies.cmake
  DESTINATION "${config_dir}" COMPONENT development)
