// SPDX-License-Identifier: Apache-2.0
// Texels of a texture and its mip levels: which to read, and how to weigh them.
//
// Texels are 8-bit RGBA words, red in the lowest byte; all levels of all textures lie in one array.
// A level is half as wide and high as the one before, rounded down but at least 1, and follows it.
#ifndef AGLOW_SHARED_TEXTURE_LOOKUP_H
#define AGLOW_SHARED_TEXTURE_LOOKUP_H
#include "aglow/shared/ray.h"
AG_NAMESPACE_BEGIN

AG_CONST uint kWrapRepeat = 0u;
AG_CONST uint kWrapMirrored = 1u;
AG_CONST uint kWrapClamp = 2u;
AG_CONST uint kNoTexture = 0xffffffffu;

// An image in one coding with its sampler. 32 bytes.
struct TextureLevels {
    uint first_texel;   // of level 0
    int width, height;  // of level 0
    uint level_count;
    uint wrap_s, wrap_t;  // kWrap...
    uint nearest;         // 1: magnified without blending texels
    uint srgb;            // 1: red, green and blue are sRGB-coded
};
AG_BUFFER_OF(TextureLevels);

// How a material reads a texture: s = dot(to_s, uv) + offset.x, t = dot(to_t, uv) + offset.y.
// 32 bytes.
struct TextureUse {
    uint texture;   // index of its TextureLevels; kNoTexture: every channel reads 1
    uint texcoord;  // set of texture coordinates
    vec2 to_s, to_t, offset;
};

// The four texels around a point: indices into the array of texels, and how far the point is from
// the first towards its right and lower neighbours.
struct TexelQuad {
    uint upper_left, upper_right, lower_left, lower_right;
    float right, down;
};

AG_FN vec2 texture_coordinates(TextureUse use, vec2 uv) {
    vec2 st;
    st.x = dot(use.to_s, uv) + use.offset.x;
    st.y = dot(use.to_t, uv) + use.offset.y;
    return st;
}

// A coordinate in the period of the texture that matters, so that far ones keep their precision.
// One that is not finite lands at 0.
AG_FN float wrapped_coordinate(float coordinate, uint wrap) {
    float period = wrap == kWrapMirrored ? 2.0f : 1.0f;
    float result = wrap == kWrapClamp ? clamp(coordinate, 0.0f, 1.0f)
                                      : coordinate - period * floor(coordinate / period);
    return result >= 0.0f && result <= period ? result : 0.0f;
}

// The texel for an index up to one period outside of [0, size). Divisions would take longer than
// all else that a look-up does.
AG_FN int wrapped_texel(int index, int size, uint wrap) {
    if (wrap == kWrapClamp) return index < 0 ? 0 : index < size ? index : size - 1;
    int period = wrap == kWrapMirrored ? 2 * size : size;
    int in_period = index < 0 ? index + period : index >= period ? index - period : index;
    return in_period < size ? in_period : 2 * size - 1 - in_period;
}

// The texels of `level` around st; `blend` 0 gives one texel four times.
AG_FN TexelQuad texel_quad(TextureLevels texture, vec2 st, uint level, uint blend) {
    uint first = texture.first_texel;
    int width = texture.width;
    int height = texture.height;
    for (uint i = 0u; i < level; ++i) {
        first = first + uint(width) * uint(height);
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    }
    float shift = blend != 0u ? 0.5f : 0.0f;
    float x = wrapped_coordinate(st.x, texture.wrap_s) * float(width) - shift;
    float y = wrapped_coordinate(st.y, texture.wrap_t) * float(height) - shift;
    int x0 = int(floor(x));
    int y0 = int(floor(y));
    int step = blend != 0u ? 1 : 0;
    uint left = uint(wrapped_texel(x0, width, texture.wrap_s));
    uint right = uint(wrapped_texel(x0 + step, width, texture.wrap_s));
    uint upper = first + uint(width) * uint(wrapped_texel(y0, height, texture.wrap_t));
    uint lower = first + uint(width) * uint(wrapped_texel(y0 + step, height, texture.wrap_t));
    TexelQuad quad;
    quad.upper_left = upper + left;
    quad.upper_right = upper + right;
    quad.lower_left = lower + left;
    quad.lower_right = lower + right;
    quad.right = x - floor(x);
    quad.down = y - floor(y);
    return quad;
}

AG_FN vec4 blend_quad(TexelQuad quad, vec4 upper_left, vec4 upper_right, vec4 lower_left,
                      vec4 lower_right) {
    vec4 upper = upper_left * (1.0f - quad.right) + upper_right * quad.right;
    vec4 lower = lower_left * (1.0f - quad.right) + lower_right * quad.right;
    return upper * (1.0f - quad.down) + lower * quad.down;
}

// A lightmap's texels around a point in texels (centres at k + 0.5), clamped to the edge. Indices
// are row * width + column.
AG_FN TexelQuad lightmap_quad(int width, int height, vec2 texel) {
    float x = clamp(texel.x - 0.5f, 0.0f, float(width - 1));
    float y = clamp(texel.y - 0.5f, 0.0f, float(height - 1));
    int x0 = int(x);
    int y0 = int(y);
    int x1 = x0 + 1 < width ? x0 + 1 : x0;
    int y1 = y0 + 1 < height ? y0 + 1 : y0;
    TexelQuad quad;
    quad.upper_left = uint(y0) * uint(width) + uint(x0);
    quad.upper_right = uint(y0) * uint(width) + uint(x1);
    quad.lower_left = uint(y1) * uint(width) + uint(x0);
    quad.lower_right = uint(y1) * uint(width) + uint(x1);
    quad.right = x - float(x0);
    quad.down = y - float(y0);
    return quad;
}

// The mip level whose texels are as wide as a ray's cone where it meets a triangle: 0 is the full
// resolution, fractions lie between two levels. `a`, `b`, `c` are the corners' coordinates after
// texture_coordinates(), `width` that of the cone, `cosine` that of the angle of incidence.
// Source: Akenine-Moeller et al., Ray Tracing Gems, 2019, chapter 20, equation 34.
AG_FN float texture_level(TextureLevels texture, vec2 a, vec2 b, vec2 c, float triangle_area,
                          float width, float cosine) {
    vec2 ab = b - a;
    vec2 ac = c - a;
    float size = float(texture.width) * float(texture.height);
    float texels = 0.5f * abs(ab.x * ac.y - ab.y * ac.x) * size;
    float area = max(triangle_area, 1.0e-30f);
    float across = width / max(abs(cosine), 0.01f);
    float level = 0.5f * log2(max(texels * across * across / area, 1.0e-20f));
    return clamp(level, 0.0f, float(texture.level_count - 1u));
}

AG_NAMESPACE_END
#ifdef __cplusplus
static_assert(sizeof(aglow::shared::TextureLevels) == 32);
static_assert(sizeof(aglow::shared::TextureUse) == 32);
#endif
#endif
