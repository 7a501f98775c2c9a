// SPDX-License-Identifier: Apache-2.0
#include "aglow/vk/timing_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace aglow::vk {

void TimingTable::set_label(std::string_view label) {
    auto found = std::find(labels_.begin(), labels_.end(), label);
    label_ = static_cast<uint32_t>(found - labels_.begin());
    if (found == labels_.end()) labels_.emplace_back(label);
}

uint32_t TimingTable::row(const std::shared_ptr<KernelRate>& rate, std::string_view kernel) {
    auto [known, is_new] = known_.try_emplace({label_, rate}, 0u);
    if (!is_new) return known->second;
    const std::string& label = labels_[label_];
    auto same = [&](const Timing& row) { return row.label == label && row.kernel == kernel; };
    auto row = std::find_if(rows_.begin(), rows_.end(), same);
    known->second = static_cast<uint32_t>(row - rows_.begin());
    if (row == rows_.end()) rows_.push_back({label, std::string(kernel), 0, 0});
    return known->second;
}

void TimingTable::add(uint32_t row, double seconds, bool starts_dispatch) {
    rows_[row].seconds += seconds;
    rows_[row].dispatches += starts_dispatch;
}

std::string TimingTable::describe(uint32_t row) const {
    const Timing& timing = rows_[row];
    return timing.label.empty() ? fmt::format("\"{}\"", timing.kernel)
                                : fmt::format("\"{}\" of {}", timing.kernel, timing.label);
}

std::vector<Timing> TimingTable::take() {
    std::vector<Timing> taken;
    for (Timing& row : rows_) {
        if (row.dispatches > 0 || row.seconds > 0) taken.push_back(row);
        row.seconds = 0;
        row.dispatches = 0;
    }
    return taken;
}

}  // namespace aglow::vk
