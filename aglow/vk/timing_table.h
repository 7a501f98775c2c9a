// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "aglow/vk/kernel_rate.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aglow::vk {

/// GPU time of one kernel under one label.
struct Timing {
    std::string label;   ///< of the scope that was open, "" outside of one
    std::string kernel;  ///< "copy" and "fill" for those
    double seconds = 0;
    uint64_t dispatches = 0;
};

/// Sums GPU time by label and kernel.
class TimingTable {
public:
    void set_label(std::string_view label);
    /// The row of a kernel under the label that is set. Kernels are told apart by their rate,
    /// which is kept alive until forget_kernels().
    uint32_t row(const std::shared_ptr<KernelRate>& rate, std::string_view kernel);
    void add(uint32_t row, double seconds, bool starts_dispatch);
    std::string describe(uint32_t row) const;  ///< "sort" of frame
    void forget_kernels() { known_.clear(); }
    /// What was added since the last call, in order of first appearance.
    std::vector<Timing> take();

private:
    std::vector<Timing> rows_;
    std::vector<std::string> labels_{""};
    uint32_t label_ = 0;
    std::map<std::pair<uint32_t, std::shared_ptr<KernelRate>>, uint32_t> known_;
};

}  // namespace aglow::vk
