# cmake -D source_dir=... -D work_dir=... -D generator=... -D architecture=... -P aarch64_test.cmake
find_program(compiler NAMES aarch64-linux-gnu-g++-12 aarch64-linux-gnu-g++)
if(NOT compiler)
  message("skipped: no aarch64-linux-gnu-g++")
  return()
endif()

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} -S "${source_dir}" -B "${work_dir}" -G "${generator}"
  --toolchain "${source_dir}/cmake/aarch64.cmake"
  -D "CMAKE_PROJECT_INCLUDE=${source_dir}/tests/aarch64/host_libraries.cmake" -D "EMSCAPE_HOST_ARCHITECTURE=${architecture}"
  -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_FLAGS_DEBUG=-O0
  -D EMSCAPE_CUDA=OFF -D EMSCAPE_VIEW=OFF -D EMSCAPE_TESTS=OFF)
run(${CMAKE_COMMAND} --build "${work_dir}" --target emscape_base emscape_document emscape_propagation emscape_scenario emscape_volume)
