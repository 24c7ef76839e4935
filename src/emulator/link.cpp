#include "skyloop/emulator/link.hpp"

namespace skyloop {

Link::Link(std::unique_ptr<Transport> transport, std::uint32_t receiver_baud)
    : transport_(std::move(transport)),
      to_client_(receiver_baud, receiver_baud),
      to_receiver_(receiver_baud, receiver_baud) {
    transport_->set_receiver_baud(receiver_baud);
}

Bytes Link::heard_by_client(ByteSpan bytes, std::uint32_t receiver_baud, std::uint32_t client_baud, bool at_rest) {
    to_client_.set_bauds(receiver_baud, client_baud);
    Bytes heard = to_client_.pass(bytes);
    if (at_rest) {
        const Bytes rest = to_client_.idle();
        heard.insert(heard.end(), rest.begin(), rest.end());
    }
    return heard;
}

void Link::send(ByteSpan bytes, std::uint32_t receiver_baud, bool at_rest) {
    const LineState line = transport_->line();
    connected_ = line.connected;
    if (!line.connected) {
        counters_.bytes_unheard += bytes.size();
        return;
    }
    const std::uint32_t client_baud = line.baud.value_or(receiver_baud);
    const Bytes heard = heard_by_client(bytes, receiver_baud, client_baud, at_rest);
    if (heard.empty()) return;
    const std::size_t taken = transport_->write(heard);
    counters_.bytes_out += taken;
    counters_.bytes_lost += heard.size() - taken;
    if (client_baud != receiver_baud) counters_.bytes_garbled += taken;
}

Bytes Link::receive(std::uint32_t receiver_baud) {
    const LineState line = transport_->line();
    connected_ = line.connected;
    const Bytes sent = transport_->read();
    to_receiver_.set_bauds(line.baud.value_or(receiver_baud), receiver_baud);
    // A client's bytes come in one piece between two looks at the wire; when there are none, its line rests.
    Bytes heard = sent.empty() ? to_receiver_.idle() : to_receiver_.pass(sent);
    counters_.bytes_in += heard.size();
    return heard;
}

}  // namespace skyloop
