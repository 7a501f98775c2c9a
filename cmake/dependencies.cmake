# SPDX-License-Identifier: Apache-2.0
# What Aglow links, all from Debian's packages. The installed package includes this file too,
# because static libraries hand their dependencies on to whoever links them.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(embree 3 REQUIRED)
find_package(fmt REQUIRED)
find_package(tl-expected REQUIRED PATHS /usr/share/cmake/tl-expected)
find_package(Vulkan REQUIRED)
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR)
if(NOT AGLOW_INSTALLED)
    find_package(Eigen3 REQUIRED)
    find_package(CLI11 REQUIRED)
    find_package(nlohmann_json REQUIRED)
endif()
if(NOT AGLOW_INSTALLED AND (AGLOW_BUILD_TESTS OR AGLOW_BUILD_BENCH))
    # What subdivision is compared with. Debian's OpenSubdivConfig.cmake asks for static libraries
    # that the package does not hold, so it is found by hand.
    find_path(OPENSUBDIV_INCLUDE opensubdiv/far/primvarRefiner.h)
    find_library(OPENSUBDIV_CPU osdCPU)
    if(NOT OPENSUBDIV_INCLUDE OR NOT OPENSUBDIV_CPU)
        message(FATAL_ERROR "OpenSubdiv is missing, which tests and benchmarks compare with: "
            "install libosd-dev, or configure with -DAGLOW_BUILD_TESTS=OFF -DAGLOW_BUILD_BENCH=OFF")
    endif()
    add_library(OpenSubdiv::osdCPU UNKNOWN IMPORTED)
    set_target_properties(OpenSubdiv::osdCPU PROPERTIES
        IMPORTED_LOCATION ${OPENSUBDIV_CPU} INTERFACE_INCLUDE_DIRECTORIES ${OPENSUBDIV_INCLUDE})
endif()
