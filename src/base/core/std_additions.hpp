/// One callable of several, for std::visit.
/// The middle one of many values.
/// A vector whose few elements lie inside it.
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

namespace skyloop::inline base {

/// Takes what any of its parts takes: Overloaded{[](int) { … }, [](double) { … }}.
template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
// Clang 14 does not yet deduce it for aggregates.
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

/// The middle one, or the upper of two; of at least one. Their order changes.
template <class Value>
Value middle_of(std::vector<Value>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// At most N elements, without an allocation. More than N is a mistake of the program.
template <class T, std::size_t N>
class InplaceVector {
public:
    void push_back(const T& item) {
        assert(size_ < N);
        items_[size_++] = item;
    }
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }
    [[nodiscard]] const T& operator[](std::size_t i) const { return items_[i]; }
    [[nodiscard]] T& operator[](std::size_t i) { return items_[i]; }
    [[nodiscard]] const T& front() const { return items_[0]; }
    [[nodiscard]] const T* begin() const { return items_.data(); }
    [[nodiscard]] const T* end() const { return items_.data() + size_; }
    [[nodiscard]] T* begin() { return items_.data(); }
    [[nodiscard]] T* end() { return items_.data() + size_; }

private:
    std::array<T, N> items_{};
    std::size_t size_ = 0;
};

}  // namespace skyloop::inline base
