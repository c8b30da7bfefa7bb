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
target_compile_options(merlin_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -ffp-contract=off
  -fno-math-errno -fno-trapping-math)
# The instruction set is pinned, not native: the same bits on every machine that has it. AVX2 halves the time of the
# sensors' inner loops (SSE2, the default, takes half as many floats at once); every x86 CPU since 2015 has it.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(merlin_options INTERFACE -march=x86-64-v3)
endif()
# GCC sees reads beyond Eigen's vectors of three that its own vectoriser would make, were they longer, and takes what is set in
# one of several branches (or is an empty std::optional) for uninitialised. GCC 12 sees an overlap in "literal" + std::string
# that is none (GCC bug 105651, mended in 13), and strings of a compile-time size overflow that do not (105329 and its kin).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(merlin_options INTERFACE -Wno-array-bounds -Wno-maybe-uninitialized)
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(merlin_options INTERFACE -Wno-restrict -Wno-stringop-overflow)
  endif()
endif()
# Of a file that a unity build includes, GCC takes the unnamed namespace for one of a header.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(merlin_options INTERFACE -Wno-subobject-linkage)
endif()
# Under MERLIN_SANITIZE every source is compiled with its sanitizer, and programs are linked with both. With "address" the
# undefined-behaviour sanitizer comes in where a library is not NUMERIC: of Eigen's templates it makes half as much work
# again for the compiler. "address,undefined" has both everywhere.
set(merlin_sanitized OFF)
if(MERLIN_SANITIZE)
  set(merlin_sanitized ON)
  target_compile_options(merlin_options INTERFACE -fsanitize=${MERLIN_SANITIZE} -fno-sanitize-recover=all)
  target_link_options(merlin_options INTERFACE -fsanitize=${MERLIN_SANITIZE})
  if(MERLIN_SANITIZE MATCHES address)
    target_link_options(merlin_options INTERFACE -fsanitize=undefined)
  endif()
endif()
add_library(merlin::options ALIAS merlin_options)

# What most sources include, parsed once for all of them: Eigen takes a compiler 2 to 3 s. Files still name what they use.
# Sets `result` to a target that carries the header as compiled with these options, made at the first call.
function(merlin_headers result)
  string(MAKE_C_IDENTIFIER "merlin_headers${ARGN}" name)
  if(NOT TARGET ${name})
    add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/headers.cc)
    target_link_libraries(${name} PRIVATE merlin::options Eigen3::Eigen)
    target_compile_options(${name} PRIVATE ${ARGN})
    target_precompile_headers(${name} PRIVATE <Eigen/Dense> <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream>
      <functional> <map> <memory> <optional> <span> <sstream> <string> <vector>)
  endif()
  set(${result} ${name} PARENT_SCOPE)
endfunction()

# What runs once a run, or for a test, is optimised a little only: -O3 takes the compiler half as long again.
set(merlin_cool)
if(CMAKE_BUILD_TYPE STREQUAL Release)
  set(merlin_cool -O1)
endif()

# merlin_library(name [HOT] [NUMERIC] SOURCES ... PUBLIC libs... PRIVATE libs...): target merlin_<name>, alias merlin::<name>.
# Without sources it is an interface library. HOT: has work for every frame or step. It is optimised as the build type has
# it, and a little under the sanitizers too, where tests of it would otherwise take minutes. NUMERIC: mostly Eigen's
# arithmetic, see MERLIN_SANITIZE.
function(merlin_library name)
  cmake_parse_arguments(arg "HOT;NUMERIC" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  if(NOT arg_SOURCES)
    add_library(merlin_${name} INTERFACE)
    add_library(merlin::${name} ALIAS merlin_${name})
    target_link_libraries(merlin_${name} INTERFACE merlin::options ${arg_PUBLIC})
    return()
  endif()
  set(options ${merlin_cool})
  if(arg_HOT)
    set(options)
    if(merlin_sanitized)
      set(options -O1)
    endif()
  endif()
  if(MERLIN_SANITIZE STREQUAL address AND NOT arg_NUMERIC)
    list(APPEND options -fsanitize=undefined)
  endif()
  add_library(merlin_${name} STATIC ${arg_SOURCES})
  add_library(merlin::${name} ALIAS merlin_${name})
  target_link_libraries(merlin_${name} PUBLIC merlin::options ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  target_compile_options(merlin_${name} PRIVATE ${options})
  merlin_headers(headers ${options})
  target_precompile_headers(merlin_${name} REUSE_FROM ${headers})
endfunction()
