# emscape_module(NAME SOURCES ... [LINKS ...] [PRIVATE_LINKS ...])
# A library emscape_NAME, called emscape::NAME, of one module's sources. Its public headers are in include/emscape/NAME, the
# internal ones next to the sources. Its sources are compiled in groups, which parse the headers
# once and instantiate templates once (EMSCAPE_UNITY): a name in an anonymous namespace is unique in its module. A source with
# individual options, or with SKIP_UNITY_BUILD_INCLUSION, is compiled separately.
function(emscape_module name)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS")
  add_library(emscape_${name} ${ARG_SOURCES})
  add_library(emscape::${name} ALIAS emscape_${name})
  set_target_properties(emscape_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(emscape_${name} PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
                                                    "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>"
                                                    "$<INSTALL_INTERFACE:include>")
  target_link_libraries(emscape_${name} PUBLIC ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS})
  emscape_warnings(emscape_${name})
  emscape_unity(emscape_${name})
  emscape_install(TARGETS emscape_${name} EXPORT emscape COMPONENT development)
endfunction()

# install(), if it was requested.
macro(emscape_install)
  if(EMSCAPE_INSTALL)
    install(${ARGN})
  endif()
endmacro()

# Gives a module GDAL's headers; it is not linked with the library, which is loaded at its first use (base/geodesy/gdal_functions.h).
function(emscape_gdal_headers module)
  target_include_directories(emscape_${module} SYSTEM PRIVATE $<TARGET_PROPERTY:GDAL::GDAL,INTERFACE_INCLUDE_DIRECTORIES>)
endfunction()

# Compiles the sources of a target in groups, if requested.
function(emscape_unity target)
  if(EMSCAPE_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 12)
    # a class local to a source, with members of an anonymous namespace, seems to come from a header
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# emscape_source_options(OPTIONS SOURCE ...): compile options of single sources. One that does not exist, as after a renaming, would
# lose them without a word.
function(emscape_source_options options)
  foreach(source ${ARGN})
    if(NOT EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${source}")
      message(FATAL_ERROR "compile options of a source that does not exist: ${source}")
    endif()
    set_property(SOURCE ${source} APPEND PROPERTY COMPILE_OPTIONS ${options})
  endforeach()
endfunction()

# Enables warnings, as errors if requested, for a target of the project.
function(emscape_warnings target)
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
                                           $<$<BOOL:${EMSCAPE_WERROR}>:-Werror>>
    $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra
                               $<$<BOOL:${EMSCAPE_WERROR}>:-Werror=all-warnings -Xcompiler=-Werror>>)
  if(EMSCAPE_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # the sanitizers' own code makes GCC see uninitialised values in the standard headers
    target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
  endif()
endfunction()

# emscape_precompile(TARGET HEADER ...): external headers that most sources of a target include; they are parsed once.
function(emscape_precompile target)
  target_precompile_headers(${target} PRIVATE ${ARGN})
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)  # for ccache
endfunction()

# emscape_tests(MODULE SOURCES ... [LINKS ...]): the program MODULE_tests of the tests of a module.
function(emscape_tests module)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "SOURCES;LINKS")
  add_executable(${module}_tests ${ARG_SOURCES})
  target_link_libraries(${module}_tests PRIVATE emscape::${module} ${ARG_LINKS})
  emscape_test_program(${module}_tests ${module})
endfunction()

# emscape_test_program(TARGET LABEL [PROPERTY VALUE ...]): runs a program of GoogleTest under ctest, with the label.
function(emscape_test_program target label)
  target_link_libraries(${target} PRIVATE emscape_test_support)
  emscape_precompile(${target} <gmock/gmock.h> <gtest/gtest.h>)
  # Halves the compilation time; the libraries that the tests call are still optimised, and checked for undefined behaviour.
  if(EMSCAPE_SANITIZE)
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-O0 -fno-sanitize=undefined>)
  else()
    target_compile_options(${target} PRIVATE $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O1>)
  endif()
  emscape_warnings(${target})
  emscape_add_tests(${target} ${label} ${ARGN})
endfunction()

# emscape_add_tests(TARGET LABEL [PROPERTY VALUE ...]): a test program takes longer to load than most of its tests to run, so
# ctest runs it a few times, each time with a part of its tests: TARGET.0 to .3, and TARGET.slow.0 and .1 with the label `slow`
# for the tests whose name has the prefix SLOW_. The results of the single tests are in test_results of the build folder;
# scripts/test counts them. EMSCAPE_TESTS_WITHOUT_TSAN: a list of patterns of tests that the thread sanitizer leaves out.
function(emscape_add_tests target label)
  set(left_out *SLOW_*)
  if(EMSCAPE_SANITIZE STREQUAL "thread")
    list(APPEND left_out ${EMSCAPE_TESTS_WITHOUT_TSAN})
  endif()
  list(JOIN left_out ":" left_out)
  foreach(part 0 1 2 3 slow.0 slow.1)
    set(name "${target}.${part}")
    if(part MATCHES "slow.(.)")
      set(environment "GTEST_FILTER=*SLOW_*;GTEST_TOTAL_SHARDS=2;GTEST_SHARD_INDEX=${CMAKE_MATCH_1}")
      set(labels ${label} slow)
    else()
      set(environment "GTEST_FILTER=-${left_out};GTEST_TOTAL_SHARDS=4;GTEST_SHARD_INDEX=${part}")
      set(labels ${label})
    endif()
    add_test(NAME ${name} COMMAND ${target})
    set_tests_properties(${name} PROPERTIES LABELS "${labels}" TIMEOUT 1500 ENVIRONMENT
      "${environment};GTEST_BRIEF=1;GTEST_OUTPUT=xml:${PROJECT_BINARY_DIR}/test_results/${name}.xml" ${ARGN})
  endforeach()
endfunction()
