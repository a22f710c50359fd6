# Options, and settings of every target of the project.
option(EMSCAPE_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(EMSCAPE_WERROR "Treat warnings as errors" ${PROJECT_IS_TOP_LEVEL})
option(EMSCAPE_INSTALL "Install programs, libraries and headers" ${PROJECT_IS_TOP_LEVEL})
option(EMSCAPE_UNITY "Compile the sources of the libraries in groups: half the time of a whole build" ON)
option(EMSCAPE_PYTHON_MODULE "Build the extension module of the Python package" OFF)
set(EMSCAPE_SANITIZE "" CACHE STRING "Instrumentation of every target: address, thread, fuzzer or coverage (both need clang), or empty")
set_property(CACHE EMSCAPE_SANITIZE PROPERTY STRINGS "" address thread fuzzer coverage)
set(EMSCAPE_CUDA AUTO CACHE STRING "Device code: AUTO (where CUDA is found), ON (required) or OFF")
set_property(CACHE EMSCAPE_CUDA PROPERTY STRINGS AUTO ON OFF)
option(EMSCAPE_ALL_GPUS "Machine code for all kinds of GPUs, as in packages; else for Hopper, and others compile it at the first start" OFF)
set(EMSCAPE_VIEW AUTO CACHE STRING "The window, emscape-view: AUTO (where its libraries are found), ON (required) or OFF")
set_property(CACHE EMSCAPE_VIEW PROPERTY STRINGS AUTO ON OFF)

# emscape_supported(VARIABLE OPTION ...): those of the options that the compiler knows; some exist for one processor or compiler alone.
include(CheckCXXCompilerFlag)
function(emscape_supported variable)
  set(supported "")
  foreach(option IN LISTS ARGN)
    string(MAKE_C_IDENTIFIER "EMSCAPE_HAS${option}" known)
    check_cxx_compiler_flag("${option}" ${known})
    if(${known})
      list(APPEND supported "${option}")
    endif()
  endforeach()
  set(${variable} "${supported}" PARENT_SCOPE)
endfunction()

# Gathers of vector loops as instructions: without these g++ 12 loads the elements one by one, which takes up to twice as long. The
# second form is that of g++ 13.
set(EMSCAPE_GATHERS -mtune-ctrl=use_gather_2parts,use_gather_4parts,use_gather
                    -mtune-ctrl=use_gather_2parts,use_gather_4parts,use_gather_8parts)

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Where programs find emscape_vdb.so; RPATH instead of RUNPATH, which the sanitizers' dlopen() does not read.
set(CMAKE_BUILD_RPATH "${PROJECT_BINARY_DIR}/lib/emscape")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../lib/emscape")
add_link_options(-Wl,--disable-new-dtags)
if(PROJECT_IS_TOP_LEVEL)
  if(NOT BUILD_SHARED_LIBS)  # to a path for the build alone CMake appends an empty one, which is the working directory
    set(CMAKE_BUILD_WITH_INSTALL_RPATH ON)
  endif()
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
  endif()
  find_program(EMSCAPE_CCACHE ccache)
  mark_as_advanced(EMSCAPE_CCACHE)
endif()
# Paths below the source folder are hashed as relative ones, and the working directory is not hashed: checkouts, and build folders
# of equal depth such as those of the presets and of `pip install .`, share objects. The sloppiness is needed with precompiled
# headers.
if(EMSCAPE_CCACHE)
  set(EMSCAPE_CCACHE_COMMAND "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1
    CCACHE_SLOPPINESS=pch_defines,time_macros "${EMSCAPE_CCACHE}")
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${EMSCAPE_CCACHE_COMMAND}")
  endif()
endif()

# object-size: GCC 12 reports loads well inside constant arrays. null, alignment and pointer-overflow check every access and
# double the compilation time; the address sanitizer detects the same errors.
set(address_sanitizers -fsanitize=address,undefined -fno-sanitize=object-size,null,alignment,pointer-overflow
    -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
if(EMSCAPE_SANITIZE STREQUAL "address")
  add_compile_options(${address_sanitizers})
  add_link_options(-fsanitize=address,undefined)
elseif(EMSCAPE_SANITIZE STREQUAL "thread")
  add_compile_options(-fsanitize=thread)
  add_link_options(-fsanitize=thread)
elseif(EMSCAPE_SANITIZE MATCHES "^(fuzzer|coverage)$")
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR
      "EMSCAPE_SANITIZE=${EMSCAPE_SANITIZE}: needs clang (CMAKE_CXX_COMPILER=clang++), found ${CMAKE_CXX_COMPILER_ID}")
  endif()
  if(EMSCAPE_SANITIZE STREQUAL "fuzzer")
    add_compile_options(${address_sanitizers} -fsanitize=fuzzer-no-link)
    add_link_options(-fsanitize=address,undefined)
  else()  # comparisons are not traced: that takes as long as the readers themselves
    add_compile_options(-fsanitize-coverage=inline-8bit-counters,pc-table)
  endif()
elseif(EMSCAPE_SANITIZE)
  message(FATAL_ERROR "EMSCAPE_SANITIZE=${EMSCAPE_SANITIZE}: must be address, thread, fuzzer, coverage or empty")
endif()

# The suppressions of the sanitizers are linked into each program, so that they apply however it is started.
if(EMSCAPE_SANITIZE)
  add_library(emscape_sanitizer_defaults OBJECT "${PROJECT_SOURCE_DIR}/cmake/sanitizer_defaults.cpp")
  link_libraries(
    "$<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:$<TARGET_OBJECTS:emscape_sanitizer_defaults>>")
endif()
