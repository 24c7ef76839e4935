// What boards take in silence they do: every board with all sentences, messages, systems and faults, in simulated time.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "base/core/can_frame.hpp"
#include "firmware/core/port_id.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/casic_frame.hpp"
#include "receiver/protocol/dronecan_transfer.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/receiver_needs.hpp"
#include "support/receiver_rig.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using firmware::BoardProfile;
using firmware::MakerKind;
using firmware::PortId;

std::vector<std::string> reach_boards() {
    const std::filesystem::path folder = SKYLOOP_SOURCE_DIR "/boards";
    return list_boards({&folder, 1});
}

// With the monitor on, at a speed that is no bottleneck, and all that a client could have enabled on UART1.
BoardProfile eager_board(const std::string& name) {
    BoardProfile board = test::board_named(name);
    board.baud = 8'000'000;
    board.bauds.clear();
    board.transmit_buffer_bytes = board.generated_ahead_bytes = 1 << 20;
    board.quirks.default_interference_monitor = true;
    board.timing.answer = Seconds(0.001);
    if (board.maker == MakerKind::sbf) board.sbf_blocks = {"PVTGeodetic", "AttEuler", "RFStatus", "ReceiverTime"};
    if (board.maker == MakerKind::mtk || board.maker == MakerKind::airoha || board.maker == MakerKind::unicore ||
        board.maker == MakerKind::casic || board.maker == MakerKind::quectel || board.maker == MakerKind::ufirebird) {
        board.sentences.clear();
        for (std::size_t i = 0; i < std::size(firmware::nmea_sentence_names); ++i)
            board.sentences.push_back({static_cast<firmware::NmeaSentence>(i), 1});
    }
    board.can.node_id = 42;
    if (board.maker != MakerKind::ublox) return board;
    for (const UbxMessageId message : board.messages)
        board.config[*firmware::rate_key(message, PortId::uart1)] = 1;
    board.config[firmware::key::out_protocol(PortId::uart1, firmware::protocol_ubx)] = 1;
    return board;
}

Observation observed(const SatelliteStatus& satellite) {
    Observation o;
    o.satellite = satellite.id;
    o.signal = first_signal(satellite.id.constellation);
    o.carrier = carrier_frequency(o.signal);
    o.cn0 = *satellite.cn0;
    o.pseudorange = Metres(2.2e7 + 1000.0 * satellite.id.number);
    o.carrier_phase = 1.1e8;
    o.doppler = Hertz(100);
    o.lock_time = Seconds(20);
    return o;
}

// Of all systems, with what they send, a pair of antennas and a change of the supply each few seconds.
Epoch rich_epoch(GpsTime time, bool with_observations = true) {
    Epoch epoch{test::driving_fix(time)};
    epoch.fix.position.latitude =
        Angle::degrees(47 + 1e-4 * std::fmod(to_seconds(time.time_since_epoch()).value(), 100));
    auto& satellites = epoch.fix.satellites;
    std::erase_if(satellites, [](const SatelliteStatus& s) { return s.id.number > 7; });  // PUBX,03 has room for few
    for (const SatelliteId id : {SatelliteId{Constellation::sbas, 20}, SatelliteId{Constellation::sbas, 23},
                                 SatelliteId{Constellation::qzss, 1}, SatelliteId{Constellation::navic, 1}})
        satellites.push_back({id, Angle::degrees(100), Angle::degrees(40), DbHz(41), true});
    std::sort(epoch.fix.satellites.begin(), epoch.fix.satellites.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    if (with_observations)
        for (const SatelliteStatus& satellite : epoch.fix.satellites)
            epoch.observations.signals.push_back(observed(satellite));
    epoch.observations.receive_time = time;
    epoch.subframes.push_back(
        {{Constellation::gps, 7}, Signal::l1, time, 0, std::vector<std::uint32_t>(10, 0x22C000E4)});
    epoch.relative = RelativePosition{1.0, 0.2, -0.1, Metres(0.01)};
    return epoch;
}

Bytes spoken(const std::string& body) {
    std::uint8_t sum = 0;
    for (const char c : body)
        sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
    return to_bytes(fmt::format("${}*{:02X}\r\n", body, sum));
}

// A request to the node 42, of whose transfers no two in a row have the same id.
template <class Request>
Bytes requested(const Request& request, int second) {
    const DronecanTransfer transfer{
        Request::type.kind, Request::type.id, 20, 10, 42, static_cast<std::uint8_t>(second % 32), encode_bits(request)};
    std::string lines;
    for (const CanFrame& frame : dronecan_frames(transfer, Request::type.signature))
        lines += slcan_line(frame);
    return to_bytes(lines);
}

DronecanGetSetRequest gps_type(std::optional<int> value) {
    DronecanGetSetRequest request;
    request.name = {'G', 'P', 'S', '_', 'T', 'Y', 'P', 'E'};
    if (value) request.value.tag = DronecanValue::integer_value;
    request.value.integer = value.value_or(0);
    return request;
}

// What a client of the board sets at first, so that it shows.
Bytes first_setting(MakerKind personality) {
    if (personality == MakerKind::mtk) return spoken("PMTK314,1,1,1,1,1,0,1,1,0,0,0,0,0,0,0,0,0,1,0");
    if (personality == MakerKind::airoha) return spoken("PAIR062,1,0");
    if (personality == MakerKind::sbf) return to_bytes("sso,Stream2,COM1,DOP,sec1\n");
    if (personality == MakerKind::unicore)
        return to_bytes("AGRICA 1\r\nUNIHEADINGA 1\r\nRECTIMEA 1\r\nPVTSLNA 1\r\nOBSVMA 1\r\n");
    if (personality == MakerKind::dronecan) return requested(gps_type(17), 31);
    if (personality == MakerKind::casic) return encode_casic_frame({0x06, 0x01}, Bytes{0x01, 0x02, 1, 0});  // NAV-SOL
    if (personality == MakerKind::quectel) {
        Bytes both = spoken("PQTMCFGMSGRATE,W,PQTMEOE,1,1");
        const Bytes of_airoha = spoken("PAIR062,1,0");
        both.insert(both.end(), of_airoha.begin(), of_airoha.end());
        return both;
    }
    if (personality == MakerKind::ufirebird) return to_bytes("$CFGMSG,0,1,0\r\n");
    return spoken("PUBX,40,GSV,0,0,0,0");
}

// What it says in each second: polls and settings, and corrections.
std::vector<Bytes> said_each_second(MakerKind personality, int second) {
    CfgValset items;
    items.layers = 1;
    items.pairs = {{firmware::key::rate_meas, 1000}};
    const Bytes version = encode_frame({0x0A, 0x04}, {});
    switch (personality) {
        case MakerKind::ublox:
            return {version, encode_frame({0x06, 0x08}, Bytes{0xE8, 3, 1, 0, 1, 0}), encode_frame(items),
                    encode(Rtcm3Station{})};
        case MakerKind::mtk:
            return {spoken("PMTK605")};
        case MakerKind::airoha:
            return {spoken("PAIR020")};
        case MakerKind::sbf:
            return {to_bytes("grc\n")};
        case MakerKind::unicore:
            return {to_bytes("VERSIONA\r\n"), encode(Rtcm3Station{})};
        case MakerKind::dronecan:
            return {requested(gps_type({}), second)};
        case MakerKind::casic:
            return {spoken("PCAS06,0"), encode_casic_frame({0x06, 0x00}, {})};
        case MakerKind::quectel:
            return {spoken("PQTMVERNO"), encode(Rtcm3Station{})};
        case MakerKind::ufirebird:
            return {to_bytes("$PDTINFO\r\n")};
        default:
            return {version, spoken("PMTK605"), to_bytes("grc\n")};
    }
}

struct Play {
    std::string bytes;  // with the instants at which they left
    StreamSplitter splitter{StreamProtocols{.msp = true, .mavlink = true, .sbf = true, .unicore = true, .casic = true}};
    std::vector<StreamPiece> pieces;
    std::set<Constellation> systems;
};

struct Script {
    const char* start = "2024-03-02T23:59:39Z";  // a week of GPS ends 3 s later, and the day 21 s later
    int seconds = 24;
    bool speaks = true;
    bool measures = true;
};

// One epoch a second, whatever the rate: what is compared are runs of one script.
class Player {
public:
    Player(BoardProfile board, const Script& script, firmware::ReceiverOptions options = {})
        : script_(script), receiver_(std::move(board), std::move(options)) {}

    Play play(const Fault* fault = nullptr) {
        receiver_.start(start_);
        for (int step = 0; step < 20 * script_.seconds; ++step) {
            const GpsTime now = start_ + step * 50ms;
            const int second = step / 20;
            const bool works = fault != nullptr && second >= 2 && second < script_.seconds - 2;
            const FaultMoment moment{now, difference(now, start_ + 2s), 1, nullptr, nullptr};
            if (fault != nullptr) break_receiver(*fault, moment, step, works);
            if (script_.speaks && step % 20 == 10) speak(second, now);
            if (step % 20 == 0) epoch(works ? fault : nullptr, moment);
            take(now);
        }
        return std::move(play_);
    }
    const firmware::Receiver& receiver() const { return receiver_; }

private:
    void break_receiver(const Fault& fault, const FaultMoment& moment, int step, bool works) {
        const auto& events = step == 2 * 20 ? fault.at_start : fault.at_end;
        if (step == 2 * 20 || step == 20 * (script_.seconds - 2))
            for (const firmware::ReceiverEvent& event : events)
                receiver_.happen(event, moment.now);
        firmware::FirmwareFaults faults;
        if (works && fault.firmware) fault.firmware(faults, moment);
        receiver_.set_faults(faults);
    }
    void speak(int second, GpsTime now) {
        const MakerKind personality = receiver_.board().maker;
        if (second == 0) receiver_.input(PortId::uart1, first_setting(personality), now);
        for (const Bytes& said : said_each_second(personality, second))
            receiver_.input(PortId::uart1, said, now);
    }
    void epoch(const Fault* fault, const FaultMoment& moment) {
        Epoch epoch = rich_epoch(moment.now, script_.measures);
        if (fault != nullptr && fault->epoch) fault->epoch(epoch, moment);
        receiver_.on_epoch(epoch, [&](firmware::NavigationState& state) {
            if (fault != nullptr && fault->report) fault->report(state, moment);
        });
        for (const SatelliteStatus& satellite : receiver_.state().epoch.fix.satellites)
            play_.systems.insert(satellite.id.constellation);
    }
    void take(GpsTime now) {
        for (const firmware::Receiver::Sent& sent : receiver_.output(now)) {
            if (sent.port != PortId::uart1) continue;
            play_.bytes += fmt::format("{} at {} baud: ", (now - start_).count(), sent.baud) + to_string(sent.bytes);
            for (StreamPiece& piece : play_.splitter.feed(sent.bytes))
                play_.pieces.push_back(std::move(piece));
        }
    }

    Script script_;
    GpsTime start_ = to_gps_time(*parse_utc(script_.start), LeapSeconds::announced());
    firmware::Receiver receiver_;
    Play play_;
};

UsedReceiver used(const firmware::Receiver& receiver) {
    return {receiver.board(), receiver.settings(), {PortId::uart1}};
}

std::string rtcm_name(ByteSpan frame) {
    constexpr int with_subtype = 4072;
    const int number = frame[3] << 4 | frame[4] >> 4, subtype = (frame[4] & 0x0F) << 8 | frame[5];
    return number == with_subtype ? fmt::format("RTCM-{}.{}", number, subtype) : fmt::format("RTCM-{}", number);
}

// As board files name what came.
std::set<std::string> names_of(const Play& play) {
    std::set<std::string> names;
    for (const StreamPiece& piece : play.pieces) {
        const std::string text = to_string(piece.bytes);
        if (piece.kind == StreamKind::ubx)
            names.insert(std::string(ubx_message_name(parse_frame(piece.bytes)->id).value_or("?")));
        if (piece.kind == StreamKind::nmea && text.starts_with("$PUBX,")) names.insert("PUBX-" + text.substr(6, 2));
        if (piece.kind == StreamKind::nmea && text.size() > 6) names.insert(text.substr(3, 3));
        if (piece.kind == StreamKind::rtcm3) names.insert(rtcm_name(piece.bytes));
    }
    return names;
}

TEST(BoardReach, ASentenceIsSentOrItIsSaidThatItIsNot) {
    for (const std::string& name : reach_boards())
        for (std::size_t i = 0; i < std::size(firmware::nmea_sentence_names); ++i) {
            BoardProfile board = eager_board(name);
            board.config.clear();
            board.sentences = {{static_cast<firmware::NmeaSentence>(i), 1}};
            Player player(board, {.seconds = 3, .speaks = false});
            const std::string sentence(firmware::nmea_sentence_names[i]);
            const bool silent =
                sends_periodically(used(player.receiver()), firmware::find_output_message(sentence)->id);
            EXPECT_EQ(names_of(player.play()).contains(sentence), silent) << name << " " << sentence;
        }
}

TEST(BoardReach, AMessageIsSentOrItIsSaidThatItIsNot) {
    for (const std::string& name : reach_boards()) {
        BoardProfile board = eager_board(name);
        if (board.corrections.rtk) board.config[firmware::key::tmode_mode] = 2;  // RTCM 1005 tells a fixed place
        Player player(board, {.seconds = 6});
        const MakerKind maker = player.receiver().board().maker;
        if (maker == MakerKind::sbf || maker == MakerKind::unicore) continue;  // streams are their clients' choice
        const std::set<std::string> sent = names_of(player.play());
        for (const firmware::OutputMessage& message : firmware::output_messages()) {
            const bool here = sends_periodically(used(player.receiver()), message.id);
            if (message.name == "RTCM-4072.0") continue;  // of a base that moves
            EXPECT_EQ(sent.contains(std::string(message.name)), here) << name << " " << message.name;
        }
    }
}

TEST(BoardReach, ASystemIsTrackedOrItIsSaidThatItIsNot) {
    for (const std::string& name : reach_boards())
        for (std::size_t i = 0; i < constellation_names.size(); ++i) {
            const auto system = static_cast<Constellation>(i);
            firmware::ReceiverOptions options;
            options.settings.signals = {{system, first_signal(system)}};
            Player player(eager_board(name), {.seconds = 2, .speaks = false}, options);
            const bool here = can_track(player.receiver().board(), system);
            EXPECT_EQ(player.play().systems.contains(system), here) << name << " " << constellation_names[i];
        }
}

std::map<std::string, ParameterValue, std::less<>> given_for(std::string_view kind) {
    using Texts = std::vector<std::string>;
    if (kind == "answers_selectively") return {{"messages", Texts{"MON-VER", "CFG-VALSET"}}};
    if (kind == "refuses_messages") return {{"messages", Texts{"CFG-RATE"}}};
    if (kind == "withheld_messages") return {{"messages", Texts{"GGA", "NAV-POSLLH"}}};
    if (kind == "refuses_keys") return {{"keys", Texts{"CFG-RATE-MEAS"}}};
    if (kind == "wrong_version") return {{"software", std::string("ROM 9.99")}};
    if (kind == "changed_baud") return {{"baud", 57600.0}};
    return {};
}

// Faults whose edits reach the receiver itself. The signals are a matter of the model, and the wire's faults hit
// whatever bytes there are.
bool is_of_receiver(const FaultKind& kind, const Fault& fault) {
    const bool edits = fault.epoch || fault.report || fault.firmware || !fault.at_start.empty();
    return edits && !kind.measuring_receivers_only && kind.name != "power_cut" && kind.layer != FaultLayer::wire &&
           kind.name != "antenna_open" && kind.name != "antenna_short" && kind.name != "jamming";
}

TEST(BoardReach, AFaultShowsOrItIsSaidThatItDoesNot) {
    for (const std::string& name : reach_boards()) {
        const std::string sound = Player(eager_board(name), {}).play().bytes;
        for (const FaultKind& kind : fault_kinds()) {
            const Parameters parameters = check_parameters(kind.parameters, given_for(kind.name)).parameters;
            const auto fault = kind.make(parameters, {1, std::string(kind.name)});
            if (!fault || !is_of_receiver(kind, *fault)) continue;
            Player player(eager_board(name), {});
            const std::string why = idle_parts(kind, parameters, used(player.receiver())).whole;
            EXPECT_EQ(player.play(&*fault).bytes == sound, !why.empty()) << name << " " << kind.name << ": " << why;
        }
    }
}

}  // namespace
}  // namespace skyloop
