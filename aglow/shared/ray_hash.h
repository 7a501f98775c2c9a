// SPDX-License-Identifier: Apache-2.0
// A number for the meeting of a ray and a triangle, which decides whether the ray passes a blended
// surface: the same however often it is asked, and on every device.
#ifndef AGLOW_SHARED_RAY_HASH_H
#define AGLOW_SHARED_RAY_HASH_H
#include "aglow/shared/sobol.h"
AG_NAMESPACE_BEGIN

// `origin` and `direction` are the bits of the ray's floats. The last ten are rounded away: devices
// differ in them, and rays that lie so close may pass together.
AG_FN float ray_hash(uint triangle, uvec3 origin, uvec3 direction) {
    uint hash = hash_bits(triangle);
    hash = hash_pair(hash, (origin.x + 512u) >> 10u);
    hash = hash_pair(hash, (origin.y + 512u) >> 10u);
    hash = hash_pair(hash, (origin.z + 512u) >> 10u);
    hash = hash_pair(hash, (direction.x + 512u) >> 10u);
    hash = hash_pair(hash, (direction.y + 512u) >> 10u);
    hash = hash_pair(hash, (direction.z + 512u) >> 10u);
    return unit_float(hash);
}

AG_NAMESPACE_END
#endif
