# SPDX-License-Identifier: Apache-2.0
# Files for pkg-config: welkin-<folder>.pc for each folder and welkin.pc for all of them. As the libraries are static, what they use is
# linked by whoever links them: it stands in Requires and Libs, not in their private kinds.

# By the packages' names for find_package(): what pkg-config knows them by, or how they are linked where it does not.
set(WELKIN_PC_REQUIRES_glm glm)
set(WELKIN_PC_REQUIRES_hwy libhwy)
set(WELKIN_PC_REQUIRES_Erfa erfa)
set(WELKIN_PC_REQUIRES_OpenEXR OpenEXR)
set(WELKIN_PC_REQUIRES_PNG libpng)
set(WELKIN_PC_REQUIRES_Epoxy epoxy)
set(WELKIN_PC_REQUIRES_Vdb tbb OpenEXR)
set(WELKIN_PC_LIBS_Vdb -lopenvdb)
set(WELKIN_PC_LIBS_Threads -pthread)

# From where a .pc file lies to the prefix, so that an installed tree may be moved.
set(WELKIN_PC_DIR "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}/${WELKIN_PC_DIR}" OUTPUT_VARIABLE WELKIN_PC_TO_PREFIX)

# welkin_pc(<name> <description> <libs> <requires>)
function(welkin_pc name description libs requires)
  list(REMOVE_DUPLICATES requires)
  list(JOIN requires " " requires)
  list(JOIN libs " " libs)
  configure_file("${PROJECT_SOURCE_DIR}/cmake/welkin.pc.in" "${PROJECT_BINARY_DIR}/pkgconfig/${name}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/pkgconfig/${name}.pc" DESTINATION "${WELKIN_PC_DIR}")
endfunction()

set(all "")
foreach(folder IN LISTS WELKIN_FOLDERS)
  get_target_property(requires welkin_${folder} WELKIN_FOLDERS)
  list(TRANSFORM requires PREPEND welkin-)
  set(libs -L\${libdir} -lwelkin_${folder})
  get_target_property(system_libs welkin_${folder} WELKIN_SYSTEM_LIBS)
  list(TRANSFORM system_libs PREPEND -l)
  list(APPEND libs ${system_libs})
  get_target_property(packages welkin_${folder} WELKIN_PACKAGES)
  foreach(package IN LISTS packages)
    if(NOT DEFINED WELKIN_PC_REQUIRES_${package} AND NOT DEFINED WELKIN_PC_LIBS_${package})
      message(FATAL_ERROR "cmake/WelkinPkgConfig.cmake does not know ${package}, which ${folder} links")
    endif()
    list(APPEND requires ${WELKIN_PC_REQUIRES_${package}})
    list(APPEND libs ${WELKIN_PC_LIBS_${package}})
  endforeach()
  welkin_pc(welkin-${folder} "${PROJECT_DESCRIPTION}: ${folder}" "${libs}" "${requires}")
  list(PREPEND all welkin-${folder})
endforeach()
welkin_pc(welkin "${PROJECT_DESCRIPTION}" "" "${all}")
