# Embree 4 (Debian 13) or 3.13 (Debian 12), whichever is installed; the newer if both are. Defines the target
# Embree::embree, which also sets MERLIN_EMBREE to the version for the code (sim/rays/embree.h).
find_package(embree 4 QUIET CONFIG)
if(NOT embree_FOUND)
  find_package(embree 3.13 QUIET CONFIG)
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Embree REQUIRED_VARS embree_DIR VERSION_VAR embree_VERSION)
if(Embree_FOUND AND NOT TARGET Embree::embree)
  string(REGEX MATCH "^[0-9]+" _embree_major ${embree_VERSION})
  add_library(Embree::embree INTERFACE IMPORTED)
  target_link_libraries(Embree::embree INTERFACE embree)
  target_compile_definitions(Embree::embree INTERFACE MERLIN_EMBREE=${_embree_major})
endif()
