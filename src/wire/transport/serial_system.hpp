/// What a serial line needs of the operating system, small enough to be played by a test.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "base/core/bytes.hpp"

namespace skyloop {

/// The system calls of a serial line and the two folders that tell of devices. Results and `errno` are those of the
/// calls; descriptors are real ones. Calls come from the loop and, while a lost device is looked for, from one other
/// thread.
class SerialSystem {
public:
    virtual ~SerialSystem() = default;
    /// open(2) for reading and writing, without waiting and without becoming its controlling process.
    virtual int open(const std::filesystem::path& device);
    /// ioctl(2) with a pointer, or null.
    virtual int control(int descriptor, unsigned long request, void* argument);
    /// ioctl(2) with a number.
    virtual int control(int descriptor, unsigned long request, int argument);
    virtual std::ptrdiff_t read(int descriptor, std::uint8_t* bytes, std::size_t most);
    virtual std::ptrdiff_t write(int descriptor, ByteSpan bytes);
    /// flock(2), exclusive and without waiting.
    virtual int lock(int descriptor);
    /// The device has hung up or is gone, as poll(2) tells.
    virtual bool gone(int descriptor);
    /// Of a clock that never jumps (CLOCK_MONOTONIC), ns.
    virtual std::int64_t now_ns();
    /// Where device nodes are.
    [[nodiscard]] virtual std::filesystem::path devices() const { return "/dev"; }
    /// Where the kernel tells of devices (sysfs).
    [[nodiscard]] virtual std::filesystem::path sysfs() const { return "/sys"; }
};

}  // namespace skyloop
