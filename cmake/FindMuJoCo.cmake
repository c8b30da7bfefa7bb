# MuJoCo from the PyPI wheel mujoco-core: headers in include/ and a versioned library without an unversioned link.
# MUJOCO_ROOT (environment or cache) names another copy. Defines the target mujoco::mujoco.
set(_mujoco_roots ${MUJOCO_ROOT} $ENV{MUJOCO_ROOT} ${PROJECT_SOURCE_DIR}/.deps/mujoco)
find_path(MuJoCo_INCLUDE_DIR mujoco/mujoco.h PATHS ${_mujoco_roots} PATH_SUFFIXES include NO_DEFAULT_PATH)
find_file(MuJoCo_LIBRARY NAMES libmujoco.so.4.0.0 PATHS ${_mujoco_roots} PATH_SUFFIXES lib NO_DEFAULT_PATH)
if(MuJoCo_LIBRARY)
  string(REGEX REPLACE ".*\\.so\\." "" MuJoCo_VERSION ${MuJoCo_LIBRARY})
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MuJoCo REQUIRED_VARS MuJoCo_LIBRARY MuJoCo_INCLUDE_DIR VERSION_VAR MuJoCo_VERSION)
if(MuJoCo_FOUND AND NOT TARGET mujoco::mujoco)
  add_library(mujoco::mujoco SHARED IMPORTED)
  set_target_properties(mujoco::mujoco PROPERTIES IMPORTED_LOCATION ${MuJoCo_LIBRARY})
  # SYSTEM: no warnings about headers that are not ours.
  target_include_directories(mujoco::mujoco SYSTEM INTERFACE ${MuJoCo_INCLUDE_DIR})
endif()
