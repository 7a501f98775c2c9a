// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/render/gpu/raster/adaptive.glsl"
#include "aglow/render/gpu/raster/pattern_vertices.glsl"
