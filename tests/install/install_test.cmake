# cmake -D build_dir=... -D consumer_dir=... -D work_dir=... -D generator=... -D compiler=... -D scenario=... -P install_test.cmake
set(prefix "${work_dir}/prefix")
set(consumer_build "${work_dir}/consumer")
file(REMOVE_RECURSE "${prefix}" "${consumer_build}")

function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install "${build_dir}" --prefix "${prefix}")
run(${CMAKE_COMMAND} -S "${consumer_dir}" -B "${consumer_build}" -G "${generator}"
    -D "CMAKE_CXX_COMPILER=${compiler}" -D "CMAKE_PREFIX_PATH=${prefix}")
run(${CMAKE_COMMAND} --build "${consumer_build}")
run("${consumer_build}/consumer" "${scenario}")
if(NOT output STREQUAL "power_density_dbwm2 4096\n")
  message(FATAL_ERROR "the consumer printed: ${output}")
endif()
