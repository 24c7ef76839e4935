#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "detail/feed_link.hpp"

namespace skyloop {

pollfd FeedStream::wait(bool reads) const {
    const int events = (reads ? POLLIN : 0) | (waiting() > 0 ? POLLOUT : 0);
    return {socket_.value(), static_cast<short>(events), 0};
}

const Bytes& FeedStream::read(std::size_t most) {
    read_.resize(most);
    const auto count = ::recv(socket_.value(), read_.data(), read_.size(), MSG_DONTWAIT);
    const bool nothing = count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
    finished_ = finished_ || count == 0;
    gone_ = gone_ || (count < 0 && !nothing);
    read_.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return read_;
}

bool FeedStream::hung_up() const {
    char byte = 0;
    const auto count = ::recv(socket_.value(), &byte, 1, MSG_DONTWAIT | MSG_PEEK);
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

void FeedStream::send(ByteSpan bytes) {
    waiting_.add(bytes);
    send_waiting();
}

void FeedStream::send_waiting() {
    while (!waiting_.empty() && !gone_) {
        const ByteSpan bytes = waiting_.waiting();
        const auto count = ::send(socket_.value(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return;
        if (count < 0) gone_ = true;
        if (count > 0) waiting_.sent(static_cast<std::size_t>(count));
    }
    if (gone_) waiting_.clear();
}

void ConnectBackoff::failed(std::int64_t now_ns) {
    next_ns_ = now_ns + wait_ns_;
    wait_ns_ = std::min(2 * wait_ns_, longest_ns);
}

FileDescriptor StreamConnector::look(std::int64_t now_ns, std::string& why) {
    constexpr std::int64_t patience_ns = 5'000'000'000;
    if (!socket_.open()) {
        if (!backoff_.due(now_ns)) return {};
        socket_ = begin_connecting(peers_[next_++ % peers_.size()], why);
        begun_ns_ = now_ns;
    }
    switch (socket_.open() ? finish_connecting(socket_.value(), why) : ConnectState::failed) {
        case ConnectState::open:
            return std::move(socket_);
        case ConnectState::pending:
            if (now_ns < begun_ns_ + patience_ns) return {};
            why = "no answer";
            break;
        case ConnectState::failed:
            break;
    }
    socket_ = FileDescriptor();
    // All addresses of the host are tried before a pause.
    if (next_ % peers_.size() == 0) backoff_.failed(now_ns);
    return {};
}

void StreamConnector::lost(std::int64_t now_ns, bool lasted) {
    if (lasted) backoff_.succeeded();
    backoff_.failed(now_ns);
}

}  // namespace skyloop
