// SPDX-License-Identifier: Apache-2.0
// Adds every invocation's `term` to a sum of two words that cannot overflow: sum.x + 4096 sum.y. A
// macro, as atomics need the memory itself.
#define AG_ADD_TO_SUM(sum, term)                                             \
    {                                                                        \
        uint subgroup_sum = subgroupAdd(term);                               \
        if (subgroup_sum != 0u && subgroupElect()) {                         \
            atomicAdd(sum.x, subgroup_sum & 4095u);                          \
            if (subgroup_sum > 4095u) atomicAdd(sum.y, subgroup_sum >> 12u); \
        }                                                                    \
    }
