# One place for what every target shares: language, warnings, floating point.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

add_library(merlin_options INTERFACE)
target_compile_features(merlin_options INTERFACE cxx_std_20)
target_include_directories(merlin_options INTERFACE ${PROJECT_SOURCE_DIR})
# Contraction off: the same bits whether the compiler fuses a multiply and an add or not.
# Nobody reads errno or floating-point traps after arithmetic; without them loops may be done several elements at a time,
# with the same values.
target_compile_options(merlin_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Werror -ffp-contract=off
  -fno-math-errno -fno-trapping-math)
# The instruction set is pinned, not native: the same bits on every machine that has it. AVX2 halves the time of the
# sensors' inner loops (SSE2, the default, takes half as many floats at once); every x86 CPU since 2015 has it.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(merlin_options INTERFACE -march=x86-64-v3)
endif()
# GCC 12 sees an overlap in "literal" + std::string that is none (GCC bug 105651, mended in 13), and reads beyond Eigen's
# vectors of three that its own vectoriser would make, were they longer.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(merlin_options INTERFACE -Wno-restrict -Wno-array-bounds)
endif()
# Sanitized code confuses GCC's uninitialised-value analysis (its manual says so under -fsanitize), in <regex> for one.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  target_compile_options(merlin_options INTERFACE -Wno-maybe-uninitialized)
endif()
add_library(merlin::options ALIAS merlin_options)

# merlin_library(name SOURCES ... PUBLIC libs... PRIVATE libs...): target merlin_<name>, alias merlin::<name>.
# Without sources it is an interface library.
function(merlin_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(arg_SOURCES)
    add_library(merlin_${name} STATIC ${arg_SOURCES})
    target_link_libraries(merlin_${name} PUBLIC merlin::options ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  else()
    add_library(merlin_${name} INTERFACE)
    target_link_libraries(merlin_${name} INTERFACE merlin::options ${arg_PUBLIC})
  endif()
  add_library(merlin::${name} ALIAS merlin_${name})
endfunction()
