#include "detail/actuator_lock.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

#include "base/core/digest.hpp"

namespace skyloop {

Result<std::unique_ptr<ActuatorLock>> ActuatorLock::take(const std::string& name) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    // The zero that abstract names begin with stays in front.
    const std::string text = fmt::format("skyloop/power/{:016x}", fnv1a_64(name));
    std::copy(text.begin(), text.end(), address.sun_path + 1);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
    const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0) return nullptr;
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), size) == 0)
        return std::unique_ptr<ActuatorLock>(new ActuatorLock(socket));
    const bool taken = errno == EADDRINUSE;
    ::close(socket);
    if (!taken) return nullptr;
    return fail(ErrorCode::outside,
                fmt::format("{} is switched by another run already, or by another receiver of this one", name));
}

ActuatorLock::~ActuatorLock() { ::close(socket_); }

}  // namespace skyloop
