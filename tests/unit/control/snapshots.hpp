/// A snapshot of a small run, for tests of what is made of it.
#pragma once

#include <memory>
#include <utility>

#include "run/emulator/status_snapshot.hpp"

namespace skyloop::test {

inline constexpr GpsTime control_start{Nanoseconds(1'400'000'000'000'000'000)};

inline std::shared_ptr<const DialogueLine> dialogue_line(std::uint64_t sequence) {
    DialogueLine line;
    line.sequence = sequence;
    line.time = control_start + std::chrono::seconds(1);
    line.kind = StreamKind::nmea;
    line.name = "PUBX,41";
    line.bytes = to_bytes("$PUBX,41,1,0007,0003,19200,0*25\r\n");
    line.size = line.bytes.size();
    return std::make_shared<const DialogueLine>(std::move(line));
}

inline StatusSnapshot small_snapshot() {
    StatusSnapshot snapshot;
    snapshot.sequence = 7;
    snapshot.start = control_start;
    snapshot.time = control_start + std::chrono::seconds(12);
    snapshot.title = "hangar \"three\"";
    ReceiverStatus receiver;
    receiver.name = "front";
    receiver.board = "neo-m8n";
    receiver.epoch = control_start + std::chrono::seconds(11);
    receiver.truth = Geodetic::degrees(48, 11, 500);
    receiver.fix.type = FixType::fix_3d;
    receiver.fix.position = Geodetic::degrees(48, 11, 502);
    receiver.error = EnuError{Metres(0), Metres(0), Metres(2)};
    SatelliteSeen satellite;
    satellite.id = {Constellation::gps, 7};
    satellite.elevation = Angle::degrees(40);
    satellite.state = Reception::reflected;
    satellite.signals = {{Signal::l1, DbHz(44.5)}};
    receiver.satellites.push_back(satellite);
    WireStatus wire;
    wire.port = "uart1";
    wire.baud = 9600;
    wire.bytes_out = 1234;
    receiver.wires.push_back(wire);
    snapshot.receivers.push_back(receiver);
    TimelineBar bar;
    bar.name = "wet plug";
    bar.kind = "byte_loss";
    bar.begins = control_start + std::chrono::seconds(10);
    bar.active = true;
    bar.strength = 0.5;
    snapshot.timeline.push_back(bar);
    snapshot.verdicts.push_back({"copes", "no fix within 2 s", "pending", ""});
    for (std::uint64_t i = 1; i <= 100; ++i)
        snapshot.dialogue.push_back(dialogue_line(i));
    snapshot.messages.push_back({0, 0, true, StreamKind::nmea, "PUBX,41", 100});
    snapshot.events.push_back(
        std::make_shared<const EventLine>(EventLine{3, control_start, "fault begins", "wet plug"}));
    return snapshot;
}

}  // namespace skyloop::test
