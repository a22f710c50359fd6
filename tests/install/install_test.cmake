# cmake -D part=... -D build_dir=... -D source_dir=... -D work_dir=... -D generator=... -D compiler=... -P install_test.cmake
set(prefix "${work_dir}/prefix")
file(REMOVE_RECURSE "${work_dir}")

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# The public headers, included one by one in sources of their own, with nothing but the standard library and each other
# to be found.
function(check_headers)
  file(GLOB_RECURSE headers RELATIVE "${prefix}/include" "${prefix}/include/*")
  list(LENGTH headers count)
  if(count LESS 40)
    message(FATAL_ERROR "only ${count} headers are installed")
  endif()
  file(READ "${prefix}/include/emscape/emscape.h" all)
  set(sources "")
  foreach(header IN LISTS headers)
    file(STRINGS "${prefix}/include/${header}" includes REGEX "^ *# *include")
    foreach(line IN LISTS includes)
      # A header of the standard library has neither a folder nor an ending.
      if(NOT line MATCHES "^#include (<[a-z_0-9]+>|\"emscape/[a-z_0-9/]+\\.h\")")
        message(FATAL_ERROR "${header}: ${line}\nA public header includes public headers and the standard library alone.")
      endif()
    endforeach()
    if(NOT header STREQUAL "emscape/emscape.h" AND NOT all MATCHES "\"${header}\"")
      message(FATAL_ERROR "emscape/emscape.h does not include ${header}")
    endif()
    string(MAKE_C_IDENTIFIER "${header}" name)
    file(WRITE "${work_dir}/headers/${name}.cpp" "#include <${header}>\n#include <${header}>\n")
    list(APPEND sources "${name}.cpp")
  endforeach()
  list(JOIN sources " " sources)
  file(WRITE "${work_dir}/headers/CMakeLists.txt"
    "cmake_minimum_required(VERSION 3.25)\nproject(headers LANGUAGES CXX)\nadd_library(headers OBJECT ${sources})\n"
    "target_compile_features(headers PRIVATE cxx_std_17)\n"
    "target_compile_options(headers PRIVATE -Wall -Wextra -Werror -isystem ${prefix}/include)\n")
  run(${CMAKE_COMMAND} -S "${work_dir}/headers" -B "${work_dir}/headers/build" -G "${generator}"
      -D "CMAKE_CXX_COMPILER=${compiler}")
  # leaves no objects, so the sources are compiled and nothing is linked.
  run(${CMAKE_COMMAND} --build "${work_dir}/headers/build")
endfunction()

# Builds a project against what was installed.
function(build_project source build)
  run(${CMAKE_COMMAND} -S "${source}" -B "${build}" -G "${generator}"
      -D "CMAKE_CXX_COMPILER=${compiler}" -D "CMAKE_PREFIX_PATH=${prefix}")
  run(${CMAKE_COMMAND} --build "${build}")
endfunction()

function(check_examples)
  set(build "${work_dir}/examples")
  build_project("${source_dir}/examples" "${build}")
  set(scenario "${source_dir}/scenarios/jacksboro.yaml")
  run("${build}/field" "${scenario}" 0 "${work_dir}/field.vdb")
  if(NOT output MATCHES "power_density_dbwm2: -?[0-9.]+\\.\\.-?[0-9.]+ dBW/m2\nat half the power: up to -?[0-9.]+ dBW/m2\n")
    message(FATAL_ERROR "field printed: ${output}")
  endif()
  run("${build}/picture" "${scenario}" 40 "${work_dir}/picture.png")
  build_project("${source_dir}/tests/install/picture_check" "${work_dir}/picture_check")
  run("${work_dir}/picture_check/picture_check" "${work_dir}/picture.png")
  run("${build}/series" "${scenario}" "${work_dir}/series")
  foreach(file field.vdb picture.png series/jacksboro_0001.vti series/jacksboro.pvd)
    if(NOT EXISTS "${work_dir}/${file}")
      message(FATAL_ERROR "no ${file} was written")
    endif()
  endforeach()
endfunction()

run(${CMAKE_COMMAND} --install "${build_dir}" --prefix "${prefix}")
if(part MATCHES "Headers")
  check_headers()
else()
  check_examples()
endif()
