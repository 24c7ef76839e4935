#include "skyloop/emulator/dialogue.hpp"

#include <fmt/format.h>

#include "skyloop/protocol/nmea_sentence.hpp"
#include "skyloop/protocol/ubx_frame.hpp"
#include "skyloop/protocol/ubx_names.hpp"

namespace skyloop {
namespace {

StreamSplitter watching_splitter(bool of_client) {
    StreamProtocols protocols;
    protocols.impatient = of_client;
    protocols.msp = protocols.mavlink = protocols.sbf = !of_client;
    return StreamSplitter(protocols);
}

std::string ubx_name(ByteSpan frame) {
    const auto parsed = parse_frame(frame);
    if (!parsed) return "UBX";
    if (const auto name = ubx_message_name(parsed->id)) return std::string(*name);
    return "UBX-" + to_string(parsed->id);
}

// The address without its talker; of proprietary ones with the number behind it: "PUBX,41".
std::string sentence_name(ByteSpan line) {
    const std::string text(line.begin(), line.end());
    const std::size_t begin = text.find_first_of("$!"), end = text.find_first_of(",*", begin + 1);
    if (begin == std::string::npos || end == std::string::npos) return "NMEA";
    const std::string address = text.substr(begin + 1, end - begin - 1);
    if (address == "PUBX") return text.substr(begin + 1, text.find_first_of(",*", end + 1) - begin - 1);
    if (address.starts_with("P") || address.size() < 5) return address;
    return address.substr(2);
}

std::string rtcm_name(ByteSpan frame) {
    if (frame.size() < 5) return "RTCM";
    return fmt::format("RTCM-{}", frame[3] << 4 | frame[4] >> 4);
}

}  // namespace

std::string message_name(StreamKind kind, ByteSpan message) {
    switch (kind) {
        case StreamKind::ubx:
            return ubx_name(message);
        case StreamKind::nmea:
            return sentence_name(message);
        case StreamKind::rtcm3:
            return rtcm_name(message);
        case StreamKind::msp:
            return "MSP";
        case StreamKind::mavlink:
            return "MAVLink";
        case StreamKind::sbf:
            return "SBF";
        case StreamKind::noise:
            return "noise";
    }
    return "noise";
}

Dialogue::Ends& Dialogue::ends(std::size_t wire) {
    while (ends_.size() <= wire)
        ends_.push_back({watching_splitter(true), watching_splitter(false)});
    return ends_[wire];
}

void Dialogue::client_said(std::size_t wire, ByteSpan bytes, GpsTime now) {
    if (listening_) show(wire, true, ends(wire).client.feed(bytes), now);
}

void Dialogue::receiver_said(std::size_t wire, ByteSpan bytes, GpsTime now) {
    if (listening_) show(wire, false, ends(wire).receiver.feed(bytes), now);
}

void Dialogue::show(std::size_t wire, bool from_client, const std::vector<StreamPiece>& pieces, GpsTime now) {
    for (const StreamPiece& piece : pieces) {
        const std::string name = message_name(piece.kind, piece.bytes);
        listener_.message({now, station_, wire, from_client, piece.kind, name, piece.bytes});
    }
}

void Dialogue::client_believes(std::size_t wire, const Transport::Belief& belief, GpsTime now) {
    listener_.belief({now, station_, wire, belief.trusts, belief.reason});
}

}  // namespace skyloop
