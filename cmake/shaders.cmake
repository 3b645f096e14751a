# The shader manifest. A pass's name is its file name; adding a pass means adding its line here.
set(SOFTSHADOW_SHADERS
    hierarchy/hierarchy_convert
    hierarchy/hierarchy_sample
    hierarchy/hierarchy_reduce
    hierarchy/hierarchy_merge
    hierarchy/hierarchy_plan
    hierarchy/hierarchy_thin
    hierarchy/hierarchy_widen
    hierarchy/hierarchy_fold
    hierarchy/hierarchy_dual
    classify/classify_columns
    classify/classify_tiles
    classify/classify_pixels
    classify/classify_blocks
    evaluate/bitmask_evaluate
    evaluate/contour_evaluate
    evaluate/outline_evaluate
    evaluate/separate_evaluate
    evaluate/interpolate
    evaluate/interpolate_blocks
    evaluate/hard_evaluate
    filter/post_filter
    combine/combine_sublights)

# softshadow_embed_shaders(OUT_DIRECTORY): compiles every shader of the manifest, checks it, and writes softshi_shaders.h
# with an enumeration, names and code. Sets SOFTSHADOW_SHADER_OUTPUTS in the caller's scope.
function(softshadow_embed_shaders out)
  find_program(GLSLANG_VALIDATOR NAMES glslangValidator glslang REQUIRED)
  find_program(SPIRV_VAL spirv-val)
  if(NOT SPIRV_VAL)
    message(STATUS "spirv-val not found: shaders are compiled but not checked")
  endif()
  file(GLOB includes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/include/*.glsl ${PROJECT_SOURCE_DIR}/shaders/shared/*.h)
  set(outputs)
  set(enums)
  set(entries)
  set(headers)
  foreach(path IN LISTS SOFTSHADOW_SHADERS)
    get_filename_component(name ${path} NAME)
    string(TOUPPER ${name} upper)
    set(source ${PROJECT_SOURCE_DIR}/shaders/${path}.comp)
    set(spirv ${out}/${name}.spv)
    set(header ${out}/${name}.spv.h)
    set(check)
    if(SPIRV_VAL)
      set(check COMMAND ${SPIRV_VAL} --target-env vulkan1.1 ${spirv})
    endif()
    set(flags --target-env vulkan1.1 --quiet -I${PROJECT_SOURCE_DIR}/shaders/shared -I${PROJECT_SOURCE_DIR}/shaders/include)
    add_custom_command(
      OUTPUT ${header}
      COMMAND ${GLSLANG_VALIDATOR} ${flags} -V ${source} -o ${spirv} ${check}
      COMMAND ${GLSLANG_VALIDATOR} ${flags} -V --vn softshi_code_${name} ${source} -o ${header}
      DEPENDS ${source} ${includes}
      COMMENT "Compiling ${path}.comp"
      VERBATIM)
    list(APPEND outputs ${header})
    string(APPEND headers "#include \"${name}.spv.h\"\n")
    string(APPEND enums "    SOFTSHI_SHADER_${upper},\n")
    string(APPEND entries "    {\"${name}\", softshi_code_${name}, sizeof softshi_code_${name}},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${out}/softshi_shaders.h @ONLY CONTENT "/* Generated from cmake/shaders.cmake. */
#ifndef SOFTSHI_SHADERS_H
#define SOFTSHI_SHADERS_H

#include <stddef.h>
#include <stdint.h>

typedef enum softshi_shader {
${enums}    SOFTSHI_SHADER_COUNT
} softshi_shader;

typedef struct softshi_shader_code {
    const char *name;
    const uint32_t *words;
    size_t size; /* bytes */
} softshi_shader_code;

extern const softshi_shader_code softshi_shaders[SOFTSHI_SHADER_COUNT];

#endif
")
  file(CONFIGURE OUTPUT ${out}/softshi_shaders.c @ONLY CONTENT "/* Generated from cmake/shaders.cmake. */
#include \"softshi_shaders.h\"

${headers}
const softshi_shader_code softshi_shaders[SOFTSHI_SHADER_COUNT] = {
${entries}};
")
  set(SOFTSHADOW_SHADER_OUTPUTS ${outputs} ${out}/softshi_shaders.c PARENT_SCOPE)
endfunction()
