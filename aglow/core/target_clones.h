// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Before a function whose loops gain from wide registers: compiled a second time for processors
/// with AVX2, and the right one is taken when the program starts. Both give the same bits, since
/// products and sums are never contracted. Nothing where the compiler cannot do it.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__)
#define AGLOW_TARGET_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define AGLOW_TARGET_CLONES
#endif
