// All that every board can send and answer, against the bytes in tests/golden/boards: one message per line, in
// hexadecimal digits, and behind it the digest of how `skyloop decode` lists it, as JSON and as text.
//
// After a change that is meant to change bytes, SKYLOOP_RECORD_BOARDS=1 build/dev/tests/golden_runs_tests writes them
// anew; read the difference before committing it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/casic_frame.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/known_sbf.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "support/receiver_rig.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::test {
namespace {

namespace fs = std::filesystem;
using firmware::BoardProfile;
using firmware::MakerKind;
using firmware::PortId;
using namespace std::chrono_literals;

const fs::path recorded = SKYLOOP_SOURCE_DIR "/tests/golden/boards";

// Sums and products alone, which every machine rounds alike.
Observation observation_of(SatelliteId satellite, Signal signal, int i) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.carrier = carrier_frequency(signal);
    o.cn0 = DbHz(36.25 + i);
    o.pseudorange = Metres(21'000'000.125 + 250'000 * i);
    if (i % 4 != 3) o.carrier_phase = 110'000'000.5 + 1'250'000 * i;
    o.doppler = Hertz(-1500.25 + 375 * i);
    o.half_cycle_resolved = i % 5 != 4;
    o.lock_time = Seconds(2.5 * i);
    o.pseudorange_deviation = Metres(0.25 + 0.125 * i);
    o.carrier_phase_deviation = 0.015625;
    o.doppler_deviation = Hertz(0.125);
    return o;
}

Ephemeris record_of(SatelliteId satellite, GpsTime time) {
    const GpsTime toe = time - time.time_since_epoch() % 1h;
    if (satellite.constellation == Constellation::glonass) {
        GlonassEphemeris glonass;
        glonass.satellite = satellite;
        glonass.toe = toe + 15min;
        glonass.position_m = {10'000'000.5, -20'000'000.25, 12'000'000};
        glonass.velocity_mps = {1500.5, 250.25, -2000};
        glonass.frequency_channel = -2;
        glonass.accuracy_m = 4;
        return glonass;
    }
    KeplerEphemeris kepler;
    kepler.satellite = satellite;
    kepler.toe = kepler.toc = toe;
    kepler.sqrt_a = 5153.75;
    kepler.e = 0.0078125;
    kepler.i0 = 0.9375;
    kepler.omega0 = -1.5;
    kepler.omega = 0.75;
    kepler.m0 = 2.25;
    kepler.crs = 12.5;
    kepler.af0 = 0.0001220703125;
    kepler.tgd = -0.0000000046566128730773926;
    kepler.iode = kepler.iodc = 45;
    kepler.accuracy_m = 2;
    if (satellite.constellation == Constellation::galileo) kepler.message = NavigationMessage::inav;
    if (satellite.constellation == Constellation::beidou) kepler.message = NavigationMessage::d1;
    return kepler;
}

void receive_messages(Epoch& epoch) {
    using enum Constellation;
    const std::vector<std::uint32_t> lnav{0x22C00E18, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    const auto add = [&](SatelliteId satellite, Signal signal, std::vector<std::uint32_t> words) {
        epoch.subframes.push_back({satellite, signal, epoch.fix.time, satellite.constellation == glonass ? -2 : 0,
                                   std::move(words), record_of(satellite, epoch.fix.time)});
    };
    add({gps, 7}, Signal::l1, lnav);
    add({galileo, 8}, Signal::l1, {1, 2, 3, 4, 5, 6, 7, 8});
    add({beidou, 9}, Signal::b1i, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
    add({glonass, 6}, Signal::g1, {1, 2, 3, 4});
    add({qzss, 2}, Signal::l1, lnav);
}

// An epoch of each kind in turn: searching, differential, jammed.
Epoch golden_epoch(GpsTime time, int index) {
    Epoch epoch{driving_fix(time)};
    if (index == 0) {
        epoch.fix.type = FixType::none;
        for (SatelliteStatus& s : epoch.fix.satellites)
            s.used = false, s.has_ephemeris = s.id.number % 2 == 0;
        return epoch;
    }
    if (index == 1) epoch.fix.type = FixType::dgnss;
    epoch.fix.clock_bias = Metres(37.5);
    epoch.fix.clock_drift = MetresPerSecond(-12.25);
    epoch.fix.satellites.push_back(
        {{Constellation::sbas, 23}, Angle::degrees(200), Angle::degrees(30), DbHz(39), false});
    for (SatelliteStatus& s : epoch.fix.satellites)
        s.residual = Metres(0.5 * (s.id.number % 4) - 0.75);
    epoch.observations.receive_time = time;
    int i = 0;
    for (const SatelliteStatus& s : epoch.fix.satellites)
        for (const Signal signal : emulated_signals(s.id.constellation))
            epoch.observations.signals.push_back(observation_of(s.id, signal, i++ % 16));
    receive_messages(epoch);
    epoch.front_end.antenna = AntennaStatus::ok;
    if (index == 2) epoch.front_end.interference = Decibels(12);
    epoch.relative = RelativePosition{1.25, -0.5, 0.125, Metres(0.015625), true, true, 0, Metres(0.03125)};
    return epoch;
}

// Every sentence and block from the factory on, by a line that carries them all.
BoardProfile with_everything(BoardProfile board) {
    board.bauds.clear();
    board.baud = 4'000'000;
    board.transmit_buffer_bytes = board.generated_ahead_bytes = 1 << 20;
    board.sbf_blocks.clear();
    board.can.node_id = 42;
    if (board.maker == MakerKind::quectel) board.default_rate_hz = 1;  // ten times as many lines would tell no more
    if (board.maker == MakerKind::sbf)
        KnownSbfBlocks::any([&]<class Block>() {
            board.sbf_blocks.emplace_back(Block::message_name);
            return false;
        });
    if (board.maker == MakerKind::msp || board.maker == MakerKind::msp_v1 || board.maker == MakerKind::mavlink ||
        board.maker == MakerKind::ublox)
        return board;
    board.sentences.clear();
    for (std::size_t i = 0; i < std::size(firmware::nmea_sentence_names); ++i)
        board.sentences.push_back({static_cast<firmware::NmeaSentence>(i), 1});
    return board;
}

void switch_everything_on(ReceiverRig& rig) {
    const BoardProfile& board = rig.receiver().board();
    if (board.maker != MakerKind::ublox) return;
    std::map<std::uint32_t, std::uint64_t> rates;
    for (const UbxMessageId message : board.messages)
        if (const auto item = firmware::rate_key(message, PortId::uart1)) rates[*item] = 1;
    const auto configured = rig.receiver().configure(rates);
    EXPECT_TRUE(configured) << configured.error().message;
}

void ask_newer_makers(ReceiverRig& rig) {
    const BoardProfile board = rig.receiver().board();
    const auto say = [&](const Bytes& bytes) {
        rig.write(bytes);
        rig.run(100ms);
    };
    if (board.maker == MakerKind::casic) {
        for (const int id : {0x00, 0x01, 0x04, 0x07, 0x02})
            say(encode_casic_frame({0x06, static_cast<std::uint8_t>(id)}, {}));
        for (const int id : {0x01, 0x02, 0x03, 0x10, 0x20, 0x21, 0x22})
            say(encode_casic_frame({0x06, 0x01}, Bytes{0x01, static_cast<std::uint8_t>(id), 0xFF, 0xFF}));
        for (const char* const question : {"PCAS06,0", "PCAS06,1", "PCAS06,2", "PCAS06,5"})
            say(to_bytes(Sentence(question).finish()));
    }
    if (board.maker == MakerKind::quectel) {
        for (const char* const question :
             {"PQTMVERNO", "PQTMUNIQID", "PQTMCFGUART,R", "PQTMCFGFIXRATE,R", "PQTMCFGCNST,R", "PQTMCFGRCVRMODE,R",
              "PQTMCFGSVIN,R", "PQTMCFGPPS,R,1", "PQTMVER", "PQTMCFGMSGRATE,W,PQTMEPE,1,2",
              "PQTMCFGMSGRATE,W,PQTMVEL,1,1", "PQTMCFGMSGRATE,W,PQTMPVT,1,1", "PQTMCFGMSGRATE,W,PQTMDOP,1,1",
              "PQTMCFGMSGRATE,W,PQTMEOE,1,1"})
            say(to_bytes(Sentence(question).finish()));
        rig.run(1s);
    }
    if (board.maker == MakerKind::ufirebird)
        for (const char* const line : {"$PDTINFO\r\n", "$CFGSYS\r\n", "$CFGMSG,0,1,0\r\n", "$PDTINFO*00\r\n"})
            say(to_bytes(line));
}

void ask_everything(ReceiverRig& rig) {
    const BoardProfile board = rig.receiver().board();
    if (board.maker == MakerKind::ublox) {
        for (const UbxMessageId message : board.polled)
            if (message.message_class < firmware::class_nmea) rig.poll(message), rig.run(50ms);
        for (const auto& [message, answer] : board.legacy)
            rig.poll(message), rig.run(50ms);
    }
    for (const char* const question :
         {"EIGNQ,RMC", "EIGPQ,GGA", "PUBX,00", "PMTK605", "PMTK414", "PAIR020", "PAIR051"}) {
        rig.write(to_bytes(Sentence(question).finish()));
        rig.run(50ms);
    }
    if (board.maker == MakerKind::unicore)
        for (const char* const line : {"VERSIONB\r\n", "BESTNAVB\r\n", "AGRICA\r\n", "PVTSLNA\r\n", "RECTIMEA\r\n",
                                       "OBSVMA\r\n", "CONFIG\r\n", "MODE\r\n"}) {
            rig.write(to_bytes(line));
            rig.run(100ms);
        }
    ask_newer_makers(rig);
    if (board.maker != MakerKind::sbf) return;
    for (const char* const line : {"getReceiverCapabilities\n", "getSBFOutput\n", "getCOMSettings\n", "exeTea\n"}) {
        rig.write(to_bytes(line));
        rig.run(100ms);
    }
}

std::vector<StreamPiece> stream_of(const std::string& name) {
    ReceiverRig rig(with_everything(board_named(name)));
    switch_everything_on(rig);
    int index = 0;
    rig.world = [&](GpsTime time) { return golden_epoch(time, index++); };
    rig.run(3s);
    ask_everything(rig);
    const MakerKind maker = board_named(name).maker;
    StreamSplitter every_protocol({.msp = true,
                                   .mavlink = true,
                                   .sbf = true,
                                   .unicore = true,
                                   .can = maker == MakerKind::dronecan,
                                   .casic = maker == MakerKind::casic});
    Bytes stream;
    for (const Heard& heard : rig.heard())
        stream.insert(stream.end(), heard.piece.bytes.begin(), heard.piece.bytes.end());
    std::vector<StreamPiece> pieces = every_protocol.feed(stream);
    std::ranges::move(every_protocol.finish(), std::back_inserter(pieces));
    return pieces;
}

std::string digits_of(ByteSpan bytes) {
    std::string digits;
    for (const std::uint8_t byte : bytes)
        digits += fmt::format("{:02x}", byte);
    return digits;
}

std::string line_of(const StreamPiece& piece) {
    const DecodedMessage message = decode_piece(piece);
    const std::uint64_t listing = fnv1a_64(json_line(message, 0) + text_line(message));
    return fmt::format("{} {} {:016x}", digits_of(piece.bytes), message.name.empty() ? message.id : message.name,
                       listing);
}

std::vector<std::string> lines_in(const fs::path& file) {
    std::ifstream stream(file);
    EXPECT_TRUE(stream) << file << ": no such file";
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::vector<std::string> board_names() {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(SKYLOOP_SOURCE_DIR "/boards/receivers"))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem());
    // Those that extend another have its bytes, but for what their files say.
    std::erase_if(names, [](const std::string& name) { return board_named(name).files.size() > 1; });
    std::ranges::sort(names);
    return names;
}

class GoldenBoard : public testing::TestWithParam<std::string> {};

TEST_P(GoldenBoard, SendsAndListsTheSameBytes) {
    const std::vector<StreamPiece> pieces = stream_of(GetParam());
    ASSERT_FALSE(pieces.empty());
    const fs::path file = recorded / (GetParam() + ".hex");
    if (std::getenv("SKYLOOP_RECORD_BOARDS") != nullptr) {
        std::ofstream out(file);
        for (const StreamPiece& piece : pieces)
            out << line_of(piece) << '\n';
        return;
    }
    const std::vector<std::string> expected = lines_in(file);
    EXPECT_EQ(pieces.size(), expected.size());
    int shown = 0;
    for (std::size_t i = 0; i < std::min(pieces.size(), expected.size()) && shown < 10; ++i) {
        if (line_of(pieces[i]) == expected[i]) continue;
        ++shown;
        ADD_FAILURE() << file.filename() << ":" << i + 1 << ": expected\n"
                      << expected[i] << "\nsent\n"
                      << line_of(pieces[i]) << '\n'
                      << text_line(decode_piece(pieces[i]));
    }
}

INSTANTIATE_TEST_SUITE_P(All, GoldenBoard, testing::ValuesIn(board_names()), [](const auto& test) {
    std::string name = test.param;
    std::ranges::replace(name, '-', '_');
    return name;
});

}  // namespace
}  // namespace skyloop::test
