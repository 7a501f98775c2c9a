// SPDX-License-Identifier: Apache-2.0
// The equirectangular sky: -Z (north) at its centre column, +X (east) to the right, +Y on top.
#ifndef AGLOW_SHARED_SKY_H
#define AGLOW_SHARED_SKY_H
#include "aglow/shared/texture_lookup.h"
AG_NAMESPACE_BEGIN

// Position of a direction in the unit square of the image, and back.
AG_FN vec2 sky_position(vec3 direction) {
    vec2 uv;
    uv.x = 0.5f + atan(direction.x, -direction.z) * 0.159154943f;
    uv.y = acos(clamp(direction.y, -1.0f, 1.0f)) * 0.318309886f;
    return uv;
}

AG_FN vec3 sky_direction(vec2 uv) {
    float azimuth = (uv.x - 0.5f) * 6.28318531f;  // from -Z towards +X
    float polar = uv.y * 3.14159265f;
    vec3 direction;
    direction.x = sin(polar) * sin(azimuth);
    direction.y = cos(polar);
    direction.z = -sin(polar) * cos(azimuth);
    return direction;
}

// The pixels around a direction, blended across the seam; indices are row * width + column.
AG_FN TexelQuad sky_quad(int width, int height, vec3 direction) {
    vec2 uv = sky_position(direction);
    float x = uv.x * float(width) - 0.5f;
    float y = clamp(uv.y * float(height) - 0.5f, 0.0f, float(height - 1));
    int x0 = int(floor(x));
    int y0 = int(y);
    int y1 = y0 + 1 < height ? y0 + 1 : y0;
    uint left = uint((x0 + width) % width);
    uint right = uint((x0 + 1 + width) % width);
    TexelQuad quad;
    quad.upper_left = uint(y0) * uint(width) + left;
    quad.upper_right = uint(y0) * uint(width) + right;
    quad.lower_left = uint(y1) * uint(width) + left;
    quad.lower_right = uint(y1) * uint(width) + right;
    quad.right = x - float(x0);
    quad.down = y - float(y0);
    return quad;
}

// 1 / density (sr) of a direction at `uv` in a pixel that was chosen with `probability` and in
// which all places are equally likely.
AG_FN float sky_weight(int width, int height, float probability, vec2 uv) {
    float sine = sin(uv.y * 3.14159265f);
    float density = probability * float(width) * float(height);
    return density > 0.0f ? 19.7392088f * sine / density : 0.0f;  // 2 pi^2
}

AG_NAMESPACE_END
#endif
