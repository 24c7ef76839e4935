/// A vector whose few elements lie inside it.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace skyloop {

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

}  // namespace skyloop
