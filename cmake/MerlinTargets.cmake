# One place for what every target shares: language, warnings, floating point.
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()

add_library(merlin_options INTERFACE)
target_compile_features(merlin_options INTERFACE cxx_std_20)
target_include_directories(merlin_options INTERFACE ${PROJECT_SOURCE_DIR})
# Contraction off: the same bits whether the compiler fuses a multiply and an add or not.
target_compile_options(merlin_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Werror -ffp-contract=off)
# GCC 12 sees an overlap in "literal" + std::string that is none (GCC bug 105651, mended in 13).
target_compile_options(merlin_options INTERFACE
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>)
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
