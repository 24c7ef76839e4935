#include "skyloop/emulator/link.hpp"

namespace skyloop {

Link::Link(std::unique_ptr<Transport> transport, std::uint32_t receiver_baud) : transport_(std::move(transport)) {
    transport_->set_receiver_baud(receiver_baud);
}

void Link::send(ByteSpan bytes, std::uint32_t receiver_baud) {
    const LineState line = transport_->line();
    connected_ = line.connected;
    if (bytes.empty()) return;
    if (!line.connected) {
        counters_.bytes_unheard += bytes.size();
        return;
    }
    const std::uint32_t client_baud = line.baud.value_or(receiver_baud);
    if (client_baud == receiver_baud) {
        const std::size_t taken = transport_->write(bytes);
        counters_.bytes_out += taken;
        counters_.bytes_lost += bytes.size() - taken;
        return;
    }
    const Bytes heard = to_client_.resample(bytes, receiver_baud, client_baud);
    const std::size_t taken = transport_->write(heard);
    counters_.bytes_out += taken;
    counters_.bytes_garbled += taken;
    counters_.bytes_lost += heard.size() - taken;
}

Bytes Link::receive(std::uint32_t receiver_baud) {
    const LineState line = transport_->line();
    connected_ = line.connected;
    Bytes bytes = transport_->read();
    counters_.bytes_in += bytes.size();
    const std::uint32_t client_baud = line.baud.value_or(receiver_baud);
    if (bytes.empty() || client_baud == receiver_baud) return bytes;
    return to_receiver_.resample(bytes, client_baud, receiver_baud);
}

}  // namespace skyloop
