# SPDX-License-Identifier: Apache-2.0
# Compiles the shaders of a stage: aglow/<stage>/.../name.comp becomes the array
# aglow::<stage>::shaders::name_comp in <build>/aglow/<stage>/.../name.comp.h; so do shaders that
# draw, by their stage. Each is checked by spirv-val. An edited include compiles just the shaders
# that use it anew.
find_program(GLSLC glslc REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)

function(aglow_shaders stage)
    set(kinds comp vert tesc tese geom mesh frag)
    list(TRANSFORM kinds PREPEND ${PROJECT_SOURCE_DIR}/aglow/${stage}/*.)
    file(GLOB_RECURSE shaders CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${kinds})
    set(headers)
    foreach(shader ${shaders})
        set(source ${PROJECT_SOURCE_DIR}/${shader})
        set(binary ${PROJECT_BINARY_DIR}/${shader}.spv)
        set(words ${PROJECT_BINARY_DIR}/${shader}.words)
        set(header ${PROJECT_BINARY_DIR}/${shader}.h)
        get_filename_component(folder ${header} DIRECTORY)
        get_filename_component(name ${shader} NAME)
        string(REPLACE "." "_" identifier ${name})
        file(MAKE_DIRECTORY ${folder})
        file(CONFIGURE OUTPUT ${header} CONTENT "#pragma once
#include <cstdint>
namespace aglow::${stage}::shaders {
inline constexpr std::uint32_t ${identifier}[] =  // NOLINT(readability-identifier-naming)
#include \"${words}\"
;
}
")
        set(optimize -O)
        if(shader MATCHES "mesh$")  # of these the optimizer of Debian 12 makes invalid code
            set(optimize -O0)
        endif()
        set(compile ${GLSLC} --target-env=vulkan1.2 ${optimize} -Werror -I ${PROJECT_SOURCE_DIR}
            ${source})
        add_custom_command(OUTPUT ${words}
            COMMAND ${compile} -MD -MF ${binary}.d -MT ${words} -o ${binary}
            COMMAND ${SPIRV_VAL} --target-env vulkan1.2 --scalar-block-layout ${binary}
            COMMAND ${compile} -mfmt=c -o ${words}
            DEPENDS ${source} DEPFILE ${binary}.d
            COMMENT "Compiling ${shader}" VERBATIM)
        list(APPEND headers ${words})
    endforeach()
    add_custom_target(aglow_${stage}_shaders DEPENDS ${headers})
    add_dependencies(aglow_${stage} aglow_${stage}_shaders)
    if(NOT TARGET aglow_shaders)
        add_custom_target(aglow_shaders)  # all of them: what clang-tidy needs before a build
    endif()
    add_dependencies(aglow_shaders aglow_${stage}_shaders)
    target_include_directories(aglow_${stage} PRIVATE ${PROJECT_BINARY_DIR})
    if(TARGET ${stage}_test)
        add_dependencies(${stage}_test aglow_${stage}_shaders)
        target_include_directories(${stage}_test PRIVATE ${PROJECT_BINARY_DIR})
    endif()
endfunction()
