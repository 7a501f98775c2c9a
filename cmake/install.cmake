# SPDX-License-Identifier: Apache-2.0
# cmake --install: static libraries, public headers, the CMake package `aglow` and the command.
include(CMakePackageConfigHelpers)

get_property(stages GLOBAL PROPERTY AGLOW_STAGES)
list(TRANSFORM stages PREPEND aglow_ OUTPUT_VARIABLE stage_targets)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/aglow)

install(TARGETS aglow_all ${stage_targets} EXPORT aglow_targets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT aglow_targets NAMESPACE aglow:: FILE aglowTargets.cmake DESTINATION ${package_dir})

# Public headers lie directly in their stage, or in a solver's folder of `transport`.
foreach(stage shared ${stages})
    file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/aglow/${stage}/*.h)
    if(stage STREQUAL "vk")  # the rest shows Vulkan
        set(headers ${PROJECT_SOURCE_DIR}/aglow/vk/devices.h)
    endif()
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aglow/${stage})
endforeach()
foreach(solver gather path)
    file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/aglow/transport/${solver}/*.h)
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aglow/transport/${solver})
endforeach()

install(FILES ${PROJECT_SOURCE_DIR}/aglow/aglow.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aglow)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/aglowConfig.cmake.in
    ${PROJECT_BINARY_DIR}/aglowConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/aglowConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/aglowConfig.cmake
    ${PROJECT_BINARY_DIR}/aglowConfigVersion.cmake
    ${PROJECT_SOURCE_DIR}/cmake/dependencies.cmake DESTINATION ${package_dir})
if(AGLOW_BUILD_APPS)
    install(TARGETS aglow_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
