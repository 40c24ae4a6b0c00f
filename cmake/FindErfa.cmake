# SPDX-License-Identifier: Apache-2.0
# Finds ERFA (https://github.com/liberfa/erfa), the astronomy routines behind sky/ephemeris, which brings no CMake package of its
# own. Defines the target Erfa::erfa. Installed beside welkin-config.cmake, since whoever links Welkin links ERFA too.
find_path(Erfa_INCLUDE_DIR erfa.h)
find_library(Erfa_LIBRARY erfa)
mark_as_advanced(Erfa_INCLUDE_DIR Erfa_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Erfa REQUIRED_VARS Erfa_LIBRARY Erfa_INCLUDE_DIR)

if(Erfa_FOUND AND NOT TARGET Erfa::erfa)
  add_library(Erfa::erfa UNKNOWN IMPORTED)
  set_target_properties(Erfa::erfa PROPERTIES
    IMPORTED_LOCATION "${Erfa_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Erfa_INCLUDE_DIR}")
endif()
