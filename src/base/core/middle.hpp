/// The middle one of many values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace skyloop {

/// The middle one, or the upper of two; of at least one. Their order changes.
template <class Value>
Value middle_of(std::vector<Value>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace skyloop
