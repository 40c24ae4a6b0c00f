# SPDX-License-Identifier: Apache-2.0
# Finds OpenVDB (https://www.openvdb.org), whose own module is not on CMake's path in Debian and asks for more of Boost than its
# headers need. Defines the target Vdb::vdb. Imath's Half comes with OpenEXR; the part of Boost that the headers include is looked for
# here, since Debian's package does not bring it. Installed beside welkin-config.cmake, since whoever links Welkin links OpenVDB too.
find_path(Vdb_INCLUDE_DIR openvdb/openvdb.h)
find_path(Vdb_BOOST_INCLUDE_DIR boost/numeric/conversion/conversion_traits.hpp)
find_library(Vdb_LIBRARY openvdb)
mark_as_advanced(Vdb_INCLUDE_DIR Vdb_BOOST_INCLUDE_DIR Vdb_LIBRARY)
find_package(TBB QUIET CONFIG)
find_package(OpenEXR QUIET CONFIG)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Vdb REQUIRED_VARS Vdb_LIBRARY Vdb_INCLUDE_DIR Vdb_BOOST_INCLUDE_DIR TBB_FOUND OpenEXR_FOUND)

if(Vdb_FOUND AND NOT TARGET Vdb::vdb)
  add_library(Vdb::vdb UNKNOWN IMPORTED)
  set_target_properties(Vdb::vdb PROPERTIES
    IMPORTED_LOCATION "${Vdb_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Vdb_INCLUDE_DIR};${Vdb_BOOST_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "TBB::tbb;OpenEXR::OpenEXR"
    # Boost 1.74, which OpenVDB's headers include, gives an enumeration a value out of its range, which clang takes for an error.
    INTERFACE_COMPILE_OPTIONS "$<$<CXX_COMPILER_ID:Clang>:-Wno-enum-constexpr-conversion>")
endif()
