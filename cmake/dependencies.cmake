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
