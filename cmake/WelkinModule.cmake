# SPDX-License-Identifier: Apache-2.0
# Helpers that every folder of the house uses: one library a folder, one unit-test program a folder.

include(GNUInstallDirs)

# Compiler settings shared by all of Welkin's own targets.
# Contraction of a*b+c is off so that a field has the same value with every compiler and instruction set.
add_library(welkin_settings INTERFACE)
target_compile_features(welkin_settings INTERFACE cxx_std_20)
target_compile_options(welkin_settings INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -ffp-contract=off>
  # g++ 12 sees overlapping copies in std::string's operator+ that are not there (GCC bug 105651).
  $<BUILD_INTERFACE:$<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>>
  $<BUILD_INTERFACE:$<$<BOOL:${WELKIN_WARNINGS_AS_ERRORS}>:-Werror>>)

# What nearly every source includes can be parsed once a build instead of once a file. That hides a forgotten #include: a build that is to
# find those of a kind leaves it out. GTEST hides none: it is <gtest/gtest.h> alone, which every test includes in any case.
set(WELKIN_PRECOMPILE "" CACHE STRING "Sources that share precompiled headers: LIBRARY, PROGRAM, TEST or GTEST, several or none")

# What is compiled often and hardly computes anything itself need not be made fast as the library is. After all other flags.
set(WELKIN_PROGRAM_FLAGS "" CACHE STRING "More compiler flags for the sources of the program")
set(WELKIN_TEST_FLAGS "" CACHE STRING "More compiler flags for the sources of the tests")
set(WELKIN_DRAWING_FLAGS "" CACHE STRING "More compiler flags for what draws by OpenGL, library and tests")

# Sources are of the kinds LIBRARY, PROGRAM and TEST; those that draw of the kinds DRAWING_LIBRARY and DRAWING_TEST.

# welkin_flags(<target> <kind>) gives the target's own sources the flags of their kind.
function(welkin_flags target kind)
  string(REPLACE "DRAWING_" "" base ${kind})
  target_compile_options(${target} PRIVATE ${WELKIN_${base}_FLAGS})
  if(NOT base STREQUAL kind)
    target_compile_options(${target} PRIVATE ${WELKIN_DRAWING_FLAGS})
  endif()
endfunction()

# welkin_precompile(<target> <kind>) lets the target use them where they are wanted.
function(welkin_precompile target kind)
  string(REPLACE "DRAWING_" "" base ${kind})
  if(NOT base IN_LIST WELKIN_PRECOMPILE AND NOT (base STREQUAL "TEST" AND "GTEST" IN_LIST WELKIN_PRECOMPILE))
    return()
  endif()
  string(TOLOWER "welkin_${kind}_headers" owner)
  if(NOT TARGET ${owner})
    find_package(glm REQUIRED)
    find_package(Threads REQUIRED)
    file(GENERATE OUTPUT "${PROJECT_BINARY_DIR}/${owner}.cpp" CONTENT "")
    add_library(${owner} OBJECT "${PROJECT_BINARY_DIR}/${owner}.cpp")
    target_link_libraries(${owner} PRIVATE welkin_settings glm::glm Threads::Threads)
    if(base IN_LIST WELKIN_PRECOMPILE)
      target_precompile_headers(${owner} PRIVATE
        <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <memory> <optional> <span> <string> <string_view> <vector>
        <glm/geometric.hpp> <glm/vec2.hpp> <glm/vec3.hpp>)
    endif()
    welkin_flags(${owner} ${kind})
    if(base STREQUAL "LIBRARY")
      set_target_properties(${owner} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    elseif(base STREQUAL "TEST")
      find_package(GTest REQUIRED)
      target_link_libraries(${owner} PRIVATE GTest::gtest)
      target_precompile_headers(${owner} PRIVATE <gtest/gtest.h>)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# welkin_module(<folder> [DRAWS] SOURCES <files> [DEPENDS <welkin folders>] [PUBLIC_LIBS <targets>] [PRIVATE_LIBS <targets>])
# makes the static library welkin_<folder>, known to others as welkin::<folder>. What an installed one needs stands in its properties
# WELKIN_FOLDERS, WELKIN_PACKAGES and WELKIN_SYSTEM_LIBS: of a library Package::name, Package is what find_package() finds it by.
function(welkin_module folder)
  cmake_parse_arguments(ARG "DRAWS" "" "SOURCES;DEPENDS;PUBLIC_LIBS;PRIVATE_LIBS" ${ARGN})
  set(target welkin_${folder})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(welkin::${folder} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/welkin>)
  list(TRANSFORM ARG_DEPENDS PREPEND welkin::)
  target_link_libraries(${target}
    PUBLIC ${ARG_DEPENDS} ${ARG_PUBLIC_LIBS}
    PRIVATE $<BUILD_INTERFACE:welkin_settings> ${ARG_PRIVATE_LIBS})
  target_compile_features(${target} PUBLIC cxx_std_20)
  if(ARG_DRAWS)
    set(kind DRAWING_LIBRARY)
  else()
    set(kind LIBRARY)
  endif()
  welkin_flags(${target} ${kind})
  welkin_precompile(${target} ${kind})
  set(libs ${ARG_PUBLIC_LIBS} ${ARG_PRIVATE_LIBS})
  list(FILTER libs EXCLUDE REGEX "BUILD_INTERFACE|^\\$<\\$<BOOL:(0|OFF|FALSE|NO)?>")
  string(REGEX MATCHALL "[A-Za-z0-9_]+::" packages "${libs}")
  list(TRANSFORM packages REPLACE "::" "")
  list(FILTER libs INCLUDE REGEX "^[a-z0-9]+$")
  list(TRANSFORM ARG_DEPENDS REPLACE "^welkin::" "" OUTPUT_VARIABLE folders)
  set_target_properties(${target} PROPERTIES
    WELKIN_FOLDERS "${folders}" WELKIN_PACKAGES "${packages}" WELKIN_SYSTEM_LIBS "${libs}")
  # An export for each, so that whoever wants one folder need not have what others use.
  install(TARGETS ${target} EXPORT welkin-${folder}-targets)
endfunction()

# welkin_unit_test(<folder> [DRAWS] SOURCES <files> [LIBS <targets>]) makes the GoogleTest program test_<folder>.
# WELKIN_TEST_DATA_DIR is the absolute path of tests/data.
function(welkin_unit_test folder)
  cmake_parse_arguments(ARG "DRAWS" "" "SOURCES;LIBS" ${ARGN})
  add_executable(test_${folder} ${ARG_SOURCES})
  target_link_libraries(test_${folder} PRIVATE welkin::${folder} ${ARG_LIBS} welkin_settings GTest::gtest_main)
  target_compile_definitions(test_${folder} PRIVATE
    WELKIN_TEST_DATA_DIR="${PROJECT_SOURCE_DIR}/tests/data")
  if(ARG_DRAWS)
    set(kind DRAWING_TEST)
  else()
    set(kind TEST)
  endif()
  welkin_flags(test_${folder} ${kind})
  welkin_precompile(test_${folder} ${kind})
  gtest_discover_tests(test_${folder} DISCOVERY_MODE PRE_TEST TEST_PREFIX "${folder}/" PROPERTIES LABELS unit TIMEOUT 300)
endfunction()
