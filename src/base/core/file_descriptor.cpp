#include "base/core/file_descriptor.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

namespace skyloop::inline base {

FileDescriptor::~FileDescriptor() {
    const int reason = errno;  // whoever gives up what was opened has yet to say why
    if (descriptor_ >= 0) ::close(descriptor_);
    errno = reason;
}

FileDescriptor claim_name(std::string_view name) {
    FileDescriptor claim(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::copy(name.begin(), name.end(), address.sun_path + 1);  // the zero before it: no file
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    if (::bind(claim.value(), reinterpret_cast<const sockaddr*>(&address), size) != 0) return {};
    return claim;
}

}  // namespace skyloop::inline base
