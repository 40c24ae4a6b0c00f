# SPDX-License-Identifier: Apache-2.0
# The steps of the test install/find_package, run as a script. WORK is emptied first and may hold nothing else.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    string(JOIN " " line ${ARGN})
    message(FATAL_ERROR "failed (${result}): ${line}")
  endif()
endfunction()

file(REMOVE_RECURSE "${WORK}")
run("${CMAKE_COMMAND}" --install "${WELKIN_BUILD}" --prefix "${WORK}/prefix")

# Every installed header must compile on its own. One that its own source includes before all else has done so when Welkin was built
# (unless that was with precompiled headers); each of the others gets a source here. One more includes them all as they are installed,
# and again: once must be enough.
set(include "${WORK}/prefix/include/welkin")
file(GLOB_RECURSE headers RELATIVE "${include}" "${include}/welkin/*.h")
list(LENGTH headers count)
if(count EQUAL 0)
  message(FATAL_ERROR "no headers in ${include}")
endif()
set(all "")
foreach(header IN LISTS headers)
  string(APPEND all "#include \"${header}\"\n")
  string(REGEX REPLACE "\\.h$" ".cpp" source "${SOURCE}/${header}")
  set(first "")
  if(EXISTS "${source}" AND NOT PRECOMPILED)
    file(STRINGS "${source}" first LIMIT_COUNT 1 REGEX "^ *# *include")
  endif()
  if(NOT first STREQUAL "#include \"${header}\"")
    string(MAKE_C_IDENTIFIER "${header}" name)
    file(WRITE "${WORK}/headers/${name}.cpp" "#include \"${header}\"\n")
  endif()
endforeach()
file(WRITE "${WORK}/headers/all.cpp" "${all}${all}")

# What the folders keep for themselves is not installed.
foreach(own IN ITEMS fit/ball_system noise/fill reference/cloud_walks render/live_volumes scene/toml_reader shading/embedded_shaders)
  if(NOT EXISTS "${SOURCE}/welkin/${own}.h" OR EXISTS "${include}/welkin/${own}.h")
    message(FATAL_ERROR "welkin/${own}.h is installed, or is no more")
  endif()
endforeach()
if(NOT EXISTS "${include}/shaders/lib/air_volume.glsl")
  message(FATAL_ERROR "what engines include is not installed")
endif()

# build(<project> <more arguments>)
function(build project)
  run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/${project}" -B "${WORK}/${project}" -G "${GENERATOR}"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}" "-DCMAKE_CXX_FLAGS=${FLAGS}"
    "-DCMAKE_PREFIX_PATH=${WORK}/prefix" ${ARGN})
  run("${CMAKE_COMMAND}" --build "${WORK}/${project}")
endfunction()
build(one_folder)
run("${WORK}/one_folder/one_folder")
build(consumer "-DHEADER_SOURCES=${WORK}/headers")
run("${WORK}/consumer/consumer")
run("${WORK}/consumer/consumer_of_all")
