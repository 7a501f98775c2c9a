// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

namespace aglow::cli {

std::string processor_name();  ///< as the system calls it
int core_count();              ///< that this process may run on
uint64_t memory_bytes();       ///< of the machine

/// "AMD EPYC 9454, 2 threads"; 0 threads: one for each core.
std::string processor(int threads);

}  // namespace aglow::cli
