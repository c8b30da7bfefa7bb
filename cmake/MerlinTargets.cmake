# Settings that all targets share: language, warnings, floating point.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

add_library(merlin_options INTERFACE)
target_compile_features(merlin_options INTERFACE cxx_std_20)
target_include_directories(merlin_options INTERFACE ${PROJECT_SOURCE_DIR})
# No contraction: the bits must not depend on whether the compiler fuses multiply and add. Nobody reads errno or
# floating-point traps after arithmetic; without them the compiler can vectorise loops, with the same values.
target_compile_options(merlin_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -ffp-contract=off
  -fno-math-errno -fno-trapping-math)
# The instruction set is fixed and not "native", so that all machines compute the same bits. AVX2 halves the time of the
# sensors' inner loops compared with SSE2, the default; every x86 CPU since 2015 has it.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(merlin_options INTERFACE -march=x86-64-v3)
endif()
# False warnings of GCC: reads beyond Eigen's vectors of three, which its own vectoriser would make if they were longer,
# and uninitialised values that are set in one of several branches (or are an empty std::optional). GCC 12 also sees an
# overlap in "literal" + std::string (GCC bug 105651, fixed in 13) and overflows of strings of a constant size (105329
# and similar).
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(merlin_options INTERFACE -Wno-array-bounds -Wno-maybe-uninitialized)
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(merlin_options INTERFACE -Wno-restrict -Wno-stringop-overflow)
  endif()
endif()
# In a unity build GCC takes the unnamed namespace of an included source file for that of a header.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(merlin_options INTERFACE -Wno-subobject-linkage)
endif()
# With MERLIN_SANITIZE every source is compiled with that sanitizer, and programs are linked with both sanitizers. With
# "address", libraries that are not NUMERIC also get the undefined-behaviour sanitizer; for Eigen's templates it would
# take the compiler half as long again. "address,undefined" has both everywhere.
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

# Precompiles the headers that most sources include, because Eigen takes a compiler 2 to 3 s. Files still include what
# they use. Sets `result` to a target with the headers compiled with these options, made at the first call.
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

# Code that runs once per run, or in tests, gets little optimisation: -O3 takes the compiler half as long again.
set(merlin_cool)
if(CMAKE_BUILD_TYPE STREQUAL Release)
  set(merlin_cool -O1)
endif()

# merlin_library(name [HOT] [NUMERIC] SOURCES ... PUBLIC libs... PRIVATE libs...): target merlin_<name>, alias
# merlin::<name>. Without sources it is an interface library. HOT: runs for every frame or step. It gets the
# optimisation of the build type, and some under the sanitizers, where its tests would otherwise take minutes. NUMERIC:
# mostly Eigen's arithmetic, see MERLIN_SANITIZE.
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
