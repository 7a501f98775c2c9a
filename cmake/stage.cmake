# SPDX-License-Identifier: Apache-2.0
# One stage of the library: every source below aglow/<name> becomes target aglow_<name>, every
# *_test.cpp there one test program, run by ctest under the stage's name.

set(AGLOW_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror)

function(aglow_compile_options target)
    target_compile_options(${target} PRIVATE ${AGLOW_WARNINGS})
    if(AGLOW_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=${AGLOW_SANITIZE} -fno-omit-frame-pointer)
        target_link_options(${target} PUBLIC -fsanitize=${AGLOW_SANITIZE})
    endif()
endfunction()

function(aglow_stage name)
    cmake_parse_arguments(STAGE "" "" "USES;LINK" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/aglow/${name}/*.cpp)
    set(tests ${sources})
    list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
    list(FILTER tests INCLUDE REGEX "_test\\.cpp$")

    add_library(aglow_${name} STATIC ${sources})
    add_library(aglow::${name} ALIAS aglow_${name})
    set_target_properties(aglow_${name} PROPERTIES EXPORT_NAME ${name})
    target_include_directories(aglow_${name} PUBLIC
        $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(aglow_${name} PUBLIC cxx_std_20)
    list(TRANSFORM STAGE_USES PREPEND aglow_)
    target_link_libraries(aglow_${name} PUBLIC ${STAGE_USES} PRIVATE ${STAGE_LINK})
    aglow_compile_options(aglow_${name})

    if(AGLOW_BUILD_TESTS AND tests)
        enable_testing()
        add_executable(${name}_test ${tests} ${CMAKE_CURRENT_SOURCE_DIR}/tests/doctest_main.cpp)
        target_link_libraries(${name}_test PRIVATE aglow_${name} ${STAGE_LINK} rapidcheck)
        aglow_compile_options(${name}_test)
        add_test(NAME ${name} COMMAND ${name}_test)
    endif()
endfunction()
