// SPDX-License-Identifier: Apache-2.0
// to[to_start + i] = from[from_start + i] + rounds of mixing, which only take time.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "aglow/vk/kernel.glsl"

layout(constant_id = 0) const uint kAdd = 0u;
layout(local_size_x = 64) in;
struct ShiftArgs {
    uint first_group;
    uint count;
    uintPtr from;
    uintPtr to;
    uint from_start;
    uint to_start;
    uint rounds;
};
layout(push_constant, scalar) uniform Push { ShiftArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    uint value = args.from.at[args.from_start + i];
    // Multiplying by an odd number and by its inverse modulo 2^32 changes nothing in the end.
    for (uint round = 0u; round < args.rounds; ++round) value *= 0xcaf649a9u;
    for (uint round = 0u; round < args.rounds; ++round) value *= 0x729e6a99u;
    args.to.at[args.to_start + i] = value + kAdd;
}
