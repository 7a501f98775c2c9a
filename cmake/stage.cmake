# SPDX-License-Identifier: Apache-2.0
# One stage of the library: every source below aglow/<name> becomes target aglow_<name>, every
# *_test.cpp there one test program, run by ctest under the stage's name. TEST_LINK is for it alone.

set(AGLOW_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # g++ 12 sees overlap in every "text" + std::string (GCC bug 105651).
    list(APPEND AGLOW_WARNINGS -Wno-restrict)
endif()
if(AGLOW_WERROR)
    list(APPEND AGLOW_WARNINGS -Werror)
endif()

function(aglow_compile_options target)
    # Products and sums are rounded one by one, on every compiler and processor: results are
    # compared bit for bit.
    target_compile_options(${target} PRIVATE ${AGLOW_WARNINGS} -ffp-contract=off)
    if(AGLOW_SANITIZE)
        # g++ 12 takes members that an empty std::optional never reads for uninitialised ones.
        target_compile_options(${target} PRIVATE -fsanitize=${AGLOW_SANITIZE}
            -fno-sanitize-recover=all -fno-omit-frame-pointer
            $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
        target_link_options(${target} PUBLIC -fsanitize=${AGLOW_SANITIZE})
    endif()
endfunction()

# For code that spends its time in the library: it compiles a third faster so.
function(aglow_compile_lightly target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# A doctest program from `sources` under ctest's `name`.
function(aglow_doctest name)
    cmake_parse_arguments(TEST "" "" "SOURCES;LINK" ${ARGN})
    if(NOT TARGET aglow_doctest_main)
        add_library(aglow_doctest_main STATIC ${PROJECT_SOURCE_DIR}/tests/doctest_main.cpp)
        aglow_compile_options(aglow_doctest_main)
        aglow_compile_lightly(aglow_doctest_main)
    endif()
    add_executable(${name}_test ${TEST_SOURCES})
    target_link_libraries(${name}_test PRIVATE ${TEST_LINK} aglow_doctest_main rapidcheck)
    target_compile_definitions(${name}_test PRIVATE AGLOW_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    aglow_compile_options(${name}_test)
    aglow_compile_lightly(${name}_test)
    add_test(NAME ${name} COMMAND ${name}_test)
    # Random cases are the same in every run, and not made smaller, which can take hours:
    # set RC_PARAMS by hand to hunt with other seeds or to shrink what failed.
    set_tests_properties(${name} PROPERTIES TIMEOUT 600 ENVIRONMENT
        "RC_PARAMS=seed=1 noshrink=1;LSAN_OPTIONS=suppressions=${PROJECT_SOURCE_DIR}/tests/lsan.supp")
endfunction()

function(aglow_stage name)
    cmake_parse_arguments(STAGE "SHADERS" "" "USES;LINK;TEST_LINK" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/aglow/${name}/*.cpp)
    set(tests ${sources})
    list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")
    list(FILTER tests INCLUDE REGEX "_test\\.cpp$")

    add_library(aglow_${name} STATIC ${sources})
    add_library(aglow::${name} ALIAS aglow_${name})
    set_target_properties(aglow_${name} PROPERTIES EXPORT_NAME ${name})
    target_include_directories(aglow_${name} PUBLIC
        $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(aglow_${name} PUBLIC cxx_std_20)
    list(TRANSFORM STAGE_USES PREPEND aglow_)
    target_link_libraries(aglow_${name} PUBLIC ${STAGE_USES} tl::expected PRIVATE ${STAGE_LINK})
    aglow_compile_options(aglow_${name})

    if(AGLOW_BUILD_TESTS AND tests)
        aglow_doctest(${name} SOURCES ${tests} LINK aglow_${name} ${STAGE_LINK}
                      ${STAGE_TEST_LINK})
    endif()
    if(STAGE_SHADERS)
        aglow_shaders(${name})
    endif()
    set_property(GLOBAL APPEND PROPERTY AGLOW_STAGES ${name})
endfunction()
