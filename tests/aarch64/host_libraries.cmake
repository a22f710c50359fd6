# Finds this machine's libraries in place of those for Arm: their headers are the same, and nothing is linked.
set(CMAKE_LIBRARY_ARCHITECTURE "${EMSCAPE_HOST_ARCHITECTURE}")
list(APPEND CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES /usr/include)
add_compile_options("SHELL:-idirafter /usr/include" "SHELL:-idirafter /usr/include/${EMSCAPE_HOST_ARCHITECTURE}")
set(CMAKE_CXX_CREATE_SHARED_MODULE "\"${CMAKE_COMMAND}\" -E touch <TARGET>")
