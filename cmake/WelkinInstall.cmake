# SPDX-License-Identifier: Apache-2.0
# What an installed Welkin consists of besides the libraries, which welkin_module() installs: the headers, the CMake package, files for
# pkg-config and the program's documentation.
include(CMakePackageConfigHelpers)
include(WelkinHeaders)
include(WelkinPkgConfig)

# All folders at once.
add_library(welkin_all INTERFACE)
add_library(welkin::welkin ALIAS welkin_all)
set_target_properties(welkin_all PROPERTIES EXPORT_NAME welkin)
list(TRANSFORM WELKIN_FOLDERS PREPEND welkin:: OUTPUT_VARIABLE folders)
target_link_libraries(welkin_all INTERFACE ${folders})
install(TARGETS welkin_all EXPORT welkin-welkin-targets)

# What a folder stands on and the packages that its exported target names, for welkin-config.cmake.
set(WELKIN_COMPONENTS "")
foreach(folder IN LISTS WELKIN_FOLDERS)
  get_target_property(stands_on welkin_${folder} WELKIN_FOLDERS)
  get_target_property(packages welkin_${folder} WELKIN_PACKAGES)
  string(APPEND WELKIN_COMPONENTS
    "set(welkin_folders_of_${folder} \"${stands_on}\")\nset(welkin_packages_of_${folder} \"${packages}\")\n")
endforeach()

set(WELKIN_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/welkin")
configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/welkin-config.cmake.in" "${PROJECT_BINARY_DIR}/welkin-config.cmake"
  INSTALL_DESTINATION "${WELKIN_PACKAGE_DIR}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/welkin-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_BINARY_DIR}/welkin-config.cmake" "${PROJECT_BINARY_DIR}/welkin-config-version.cmake"
  "${PROJECT_SOURCE_DIR}/cmake/FindErfa.cmake" "${PROJECT_SOURCE_DIR}/cmake/FindEpoxy.cmake" "${PROJECT_SOURCE_DIR}/cmake/FindVdb.cmake"
  DESTINATION "${WELKIN_PACKAGE_DIR}")
foreach(folder IN LISTS WELKIN_FOLDERS ITEMS welkin)
  install(EXPORT welkin-${folder}-targets NAMESPACE welkin:: DESTINATION "${WELKIN_PACKAGE_DIR}")
endforeach()
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/README.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
