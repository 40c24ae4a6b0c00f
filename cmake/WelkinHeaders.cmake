# SPDX-License-Identifier: Apache-2.0
# Which headers are installed: those that programs of others are meant to include, and what these include in turn. A new header for
# others is named here; all that are not are a folder's own, and may change from one day to the next.
set(WELKIN_PUBLIC_HEADERS
  core/colour core/error core/image core/parallel core/param_range core/params core/random core/units core/utc_time
  noise/gradient noise/noise noise/params noise/tile noise/value
  optics/ice_phase optics/mie_droplets optics/mie_phase optics/mie_sphere optics/phase optics/rain_phase
  weather/choose_genus weather/cover weather/from_metar weather/genus weather/metar weather/present_weather weather/weather weather/wind
  sky/atmosphere sky/atmosphere_params sky/eclipse sky/ephemeris sky/light sky/milky_way sky/planets sky/star_cells sky/stars
  field/cloud_field field/cloud_layer field/cloud_map field/condensation field/cover field/cumulus_tower field/ellipsoid
  field/metaball_cumulus field/metaball_grid field/metaball_motion field/metaballs field/noise_texture
  fit/fit_metaballs
  io/atomic_file io/convert_texels io/dds io/exr io/file_extension io/frame_path io/hdr io/mipmaps io/png io/quantise io/raw
  io/texel_file io/texels io/vdb io/video io/write_image
  scene/ambient_light scene/cloud_cover scene/cloud_shapes scene/drift scene/ellipsoid_file scene/metaball_file scene/metaballs
  scene/param_docs scene/param_json scene/param_text scene/projector scene/rain_shafts scene/scene scene/scene_file
  scene/scene_files scene/sheet scene/sheet_texture scene/sky_box scene/sky_state scene/slab scene/theme
  reference/flip reference/picture_error reference/sky_film reference/sky_tracer reference/slab_tracer
  gpu/context gpu/draw gpu/framebuffer gpu/instances gpu/mesh gpu/program gpu/state_guard gpu/texture
  shading/shader_library shading/uniforms shading/view
  render/air_volume render/display render/live_sky render/sky_light render/sky_renderer render/splat_pass)
# And the shader files that are for engines.
set(WELKIN_PUBLIC_SHADERS air_volume)

# Every file that those of a list include, itself and in turn, as paths from the top of the tree.
function(welkin_closure out)
  set(open ${ARGN})
  set(closed "")
  while(open)
    list(POP_FRONT open file)
    if(file IN_LIST closed)
      continue()
    endif()
    list(APPEND closed "${file}")
    # It decides what is installed: look again when it changes.
    set_property(DIRECTORY "${PROJECT_SOURCE_DIR}" APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${file}")
    file(STRINGS "${PROJECT_SOURCE_DIR}/${file}" lines REGEX "^ *#(include|  *include) *\"(welkin|shaders)/")
    list(TRANSFORM lines REPLACE "^[^\"]*\"([^\"]*)\".*$" "\\1")
    list(APPEND open ${lines})
  endwhile()
  set(${out} "${closed}" PARENT_SCOPE)
endfunction()

list(TRANSFORM WELKIN_PUBLIC_HEADERS REPLACE "(.+)" "welkin/\\1.h" OUTPUT_VARIABLE headers)
list(TRANSFORM WELKIN_PUBLIC_SHADERS REPLACE "(.+)" "shaders/lib/\\1.glsl" OUTPUT_VARIABLE shaders)
welkin_closure(WELKIN_INSTALLED_HEADERS ${headers} ${shaders})

# <prefix>/include/welkin is the include folder: some headers compile shader files as C++ ("shaders/lib/..."), and "shaders" is too
# common a name to stand in <prefix>/include itself.
foreach(file IN LISTS WELKIN_INSTALLED_HEADERS)
  cmake_path(GET file PARENT_PATH folder)
  install(FILES "${PROJECT_SOURCE_DIR}/${file}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/welkin/${folder}")
endforeach()
