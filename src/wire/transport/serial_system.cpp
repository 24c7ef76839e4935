#include "wire/transport/serial_system.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/core/steady_clock.hpp"

namespace skyloop {

int SerialSystem::open(const std::filesystem::path& device) {
    return ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
}

int SerialSystem::control(int descriptor, unsigned long request, void* argument) {
    return ::ioctl(descriptor, request, argument);
}

int SerialSystem::control(int descriptor, unsigned long request, int argument) {
    return ::ioctl(descriptor, request, argument);
}

std::ptrdiff_t SerialSystem::read(int descriptor, std::uint8_t* bytes, std::size_t most) {
    return ::read(descriptor, bytes, most);
}

std::ptrdiff_t SerialSystem::write(int descriptor, ByteSpan bytes) {
    return ::write(descriptor, bytes.data(), bytes.size());
}

int SerialSystem::lock(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB); }

bool SerialSystem::gone(int descriptor) {
    pollfd state{descriptor, 0, 0};
    ::poll(&state, 1, 0);
    return (state.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
}

std::int64_t SerialSystem::now_ns() { return steady_clock_ns(); }

}  // namespace skyloop
