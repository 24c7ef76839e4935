#include "run/emulator/dialogue.hpp"
#include "base/core/bytes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "receiver/protocol/casic_messages.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "receiver/protocol/unicore_frame.hpp"
#include "run/fault/known_names.hpp"

namespace skyloop::inline run {
namespace {

constexpr StreamProtocols client_protocols{.casic = true};
constexpr StreamProtocols receiver_protocols{.msp = true, .mavlink = true, .sbf = true, .unicore = true, .casic = true};

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

// Of a log as text or an answer; logs in binary have no name of their own here.
std::string unicore_name(ByteSpan message) {
    const std::string text = base::to_string(message);
    const auto line = parse_unicore_line(text);
    return line ? std::string(line->name) : "UNICORE";
}

std::string casic_name(ByteSpan message) {
    const auto frame = parse_casic_frame(message);
    const std::string_view name = frame ? casic_message_name(frame->id) : std::string_view();
    return name.empty() ? "CASIC" : fmt::format("CASIC-{}", name);
}

bool is_text(const StreamPiece& piece) {
    return piece.kind == StreamKind::noise &&
           std::all_of(piece.bytes.begin(), piece.bytes.end(),
                       [](std::uint8_t byte) { return (byte >= 0x20 && byte < 0x7F) || byte == '\r' || byte == '\n'; });
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
        case StreamKind::unicore:
            return unicore_name(message);
        case StreamKind::casic:
            return casic_name(message);
        case StreamKind::can:
            return "DroneCAN";
        case StreamKind::command:
            return command_line_name(base::to_string(message)).value_or("command");
        case StreamKind::noise:
            return "noise";
    }
    return "noise";
}

Dialogue::Ends& Dialogue::ends(std::size_t wire) {
    while (ends_.size() <= wire)
        ends_.push_back({PatientSplitter(client_protocols), StreamSplitter(receiver_protocols)});
    return ends_[wire];
}

void Dialogue::client_said(std::size_t wire, ByteSpan bytes, GpsTime now) {
    if (!listening_) return;
    give_way(wire, now);
    show(wire, true, ends(wire).client.feed(bytes, now), now);
    if (command_line_) show_commands(wire, bytes, now);
}

void Dialogue::show_commands(std::size_t wire, ByteSpan bytes, GpsTime now) {
    std::vector<StreamPiece> commands;
    for (const std::string& line : ends(wire).commands.feed(bytes))
        if (command_line_name(line)) commands.push_back({StreamKind::command, to_bytes(line)});
    show(wire, true, commands, now);
}

void Dialogue::receiver_said(std::size_t wire, ByteSpan bytes, GpsTime now) {
    if (!listening_) return;
    give_way(wire, now);
    show(wire, false, ends(wire).receiver.feed(bytes), now);
}

// As the receiver does, which has its answer by now.
void Dialogue::give_way(std::size_t wire, GpsTime now) {
    PatientSplitter& client = ends(wire).client;
    const std::optional<GpsTime> at = client.gives_way_at();
    if (at && *at <= now) show(wire, true, client.give_way(), *at);
}

void Dialogue::show(std::size_t wire, bool from_client, const std::vector<StreamPiece>& pieces, GpsTime now) {
    for (const StreamPiece& piece : pieces) {
        // What a splitter takes for noise are the lines themselves.
        if (from_client && command_line_ && is_text(piece)) continue;
        const std::string name = message_name(piece.kind, piece.bytes);
        listener_.message({now, station_, wire, from_client, piece.kind, name, piece.bytes});
    }
}

void Dialogue::client_believes(std::size_t wire, const ClientBelief& belief, GpsTime now) {
    listener_.belief({now, station_, wire, belief.trusts, belief.reason});
}

}  // namespace skyloop::inline run
