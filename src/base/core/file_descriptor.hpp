/// An open file of the operating system that is closed when its owner goes.
#pragma once

#include <string_view>
#include <utility>

namespace skyloop::inline base {

/// Owns one descriptor, or none (−1).
class FileDescriptor {
public:
    FileDescriptor() = default;
    explicit FileDescriptor(int descriptor) : descriptor_(descriptor) {}
    FileDescriptor(FileDescriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    FileDescriptor& operator=(FileDescriptor&& other) noexcept {
        std::swap(descriptor_, other.descriptor_);
        return *this;
    }
    /// Leaves errno as it is.
    ~FileDescriptor();

    [[nodiscard]] int value() const { return descriptor_; }
    [[nodiscard]] bool open() const { return descriptor_ >= 0; }

private:
    int descriptor_ = -1;
};

/// A name that one program of the machine has at a time, for as long as this is open: an abstract socket, which needs
/// no folder that all users may write to, leaves nothing behind, and which the kernel takes back however a program
/// ends. Containers with a network of their own do not see each other's. @param name of at most 107 bytes
/// @return none, and errno, EADDRINUSE where somebody has it
FileDescriptor claim_name(std::string_view name);

}  // namespace skyloop::inline base
