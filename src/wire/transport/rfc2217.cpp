#include "wire/transport/rfc2217.hpp"

#include <algorithm>
#include <utility>

namespace skyloop {
namespace {

constexpr std::uint8_t doubled_byte = 255;         // IAC (RFC 854)
constexpr std::size_t most_data_waiting = 65536;   // of the client, not read yet
constexpr std::size_t most_bytes_waiting = 65536;  // for the client

}  // namespace

Rfc2217Transport::Rfc2217Transport(std::unique_ptr<TcpTransport> server)
    : server_(std::move(server)), port_("skyloop, an emulated GNSS receiver") {}

Result<std::unique_ptr<Rfc2217Transport>> Rfc2217Transport::listen(const TcpAddress& address) {
    auto server = TcpTransport::listen(address);
    if (!server) return fail(server.error());
    return std::unique_ptr<Rfc2217Transport>(new Rfc2217Transport(std::move(*server)));
}

// What an earlier client has written is heard; its commands are nobody's any more.
void Rfc2217Transport::meet_client() {
    met_ = server_->connections();
    waiting_.clear();
    port_.begin();
}

void Rfc2217Transport::follow() {
    if (unparsed_.empty() && port_.data_waiting() < most_data_waiting) {
        Bytes fresh = server_->read();
        if (server_->connections() != met_) meet_client();
        unparsed_ = std::move(fresh);
    }
    parsed_ += port_.receive(ByteSpan(unparsed_).subspan(parsed_));
    if (parsed_ == unparsed_.size()) {
        unparsed_.clear();
        parsed_ = 0;
    }
    if (server_->connections() != met_ || waiting_.size() > most_bytes_waiting) return;
    const Bytes answers = port_.take_answers();
    waiting_.insert(waiting_.end(), answers.begin(), answers.end());
    send_waiting();
}

void Rfc2217Transport::send_waiting() {
    if (waiting_.empty()) return;
    const std::size_t taken = server_->write(waiting_);
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taken));
}

std::size_t Rfc2217Transport::write(ByteSpan bytes) {
    follow();
    // Nor is anything for a next client that is not met yet: its options come first.
    if (!server_->line().connected || server_->connections() != met_) return bytes.size();
    if (port_.settings().suspended || !waiting_.empty()) return 0;
    std::size_t left = server_->write(ComPortServer::escaped(bytes));
    std::size_t taken = 0;
    for (; taken < bytes.size() && left > 0; ++taken) {
        const std::size_t width = bytes[taken] == doubled_byte ? 2 : 1;
        // Half of a pair has left: the other half must come next.
        if (left < width) waiting_.push_back(doubled_byte);
        left -= std::min(left, width);
    }
    return taken;
}

// What stood there at the last look: with bytes that came since, the speed may have changed.
Bytes Rfc2217Transport::read() {
    Bytes data = port_.take_data();
    follow();
    return data;
}

LineState Rfc2217Transport::line() {
    follow();
    return {server_->line().connected, port_.settings().baud};
}

std::string Rfc2217Transport::description() const {
    const std::string under = server_->description();
    return under.substr(0, under.rfind(' ')) + " (rfc2217)";
}

}  // namespace skyloop
