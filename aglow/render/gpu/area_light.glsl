// SPDX-License-Identifier: Apache-2.0
// What shadow rays to the sky and to emissive triangles share. To be included after the shader's
// `args`.

// What `u` picks of cumulative shares.
struct Pick {
    uint index;
    float share;   // its own
    float within;  // where u lies within that share, 0 to 1
};

Pick pick(floatPtr sums, uint first, uint count, float u) {
    uint low = 0u;
    uint high = count - 1u;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (sums.at[first + middle] > u)
            high = middle;
        else
            low = middle + 1u;
    }
    float before = low == 0u ? 0.0f : sums.at[first + low - 1u];
    float share = sums.at[first + low] - before;
    float within = share > 0.0f ? clamp((u - before) / share, 0.0f, 1.0f) : 0.5f;
    return Pick(low, share, within);
}

// The side of a surface that the viewer sees.
struct Side {
    vec3 origin, normal, geometric_normal;
};

Side seen_side(WavefrontSurface s) {
    float sign_of_side = s.front != 0u ? 1.0f : -1.0f;
    Side side;
    side.normal = s.normal * sign_of_side;
    side.geometric_normal = s.geometric_normal * sign_of_side;
    side.origin = s.position + side.geometric_normal * clearance(s.magnitude);
    return side;
}

// The numbers that a path is lit by: the seed of its pixel, and which sample it is.
uvec2 draw_of(uint path, uint draw) {
    uint width = args.frame.at[0].view.width;
    uvec2 pixel = tile_pixel(args.first_pixel + path % args.pixel_count, width);
    return uvec2(draw_seed(args.frame.at[0].seed, pixel.y * width + pixel.x, args.depth, draw),
                 args.first_sample + path / args.pixel_count);
}

