// However a client's bytes arrive, the receiver does the same; and an hour of polls finds none unanswered (RECEIVER.md
// 8).
#include <gtest/gtest.h>

#include <malloc.h>

#include <map>
#include <ostream>

#include "base/core/random.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "support/receiver_rig.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::ReceiverRig;

constexpr const char* u_blox_boards[] = {"ublox-m8", "ublox-m9", "ublox-m10", "ublox-f9p"};
constexpr UbxMessageId mon_ver{0x0A, 0x04}, nav_pvt{0x01, 0x07}, nav_dop{0x01, 0x04}, cfg_rate{0x06, 0x08},
    cfg_msg{0x06, 0x01}, cfg_nav5{0x06, 0x24}, cfg_valget{0x06, 0x8B}, cfg_valset{0x06, 0x8A};

Bytes joined(const std::vector<Bytes>& frames) {
    Bytes all;
    for (const Bytes& frame : frames)
        all.insert(all.end(), frame.begin(), frame.end());
    return all;
}

// A client's dialogue: identify, configure by both ways, read back.
std::vector<Bytes> dialogue() {
    CfgValset set;
    set.layers = 1;
    set.pairs = {{0x20910007, 1}, {0x30210001, 1000}};
    CfgValgetPoll get;
    get.keys = {0x30210001};
    return {encode_frame(mon_ver, {}),
            encode_frame(CfgMsgCurrentPort{0x01, 0x07, 1}),
            encode_frame(CfgRate{1000, 1, 1}),
            encode_frame(set),
            encode_frame(get),
            encode_frame(cfg_rate, {}),
            to_bytes("$PUBX,40,GLL,0,0,0,0,0,0*5C\r\n"),
            encode_frame(CfgMsgPoll{0xF0, 0x01}),
            encode_frame(cfg_nav5, {})};
}

// The answers to commands, without what comes periodically.
std::vector<Bytes> answers(const ReceiverRig& rig, std::vector<test::Heard> heard) {
    static_cast<void>(rig);
    std::vector<Bytes> found;
    for (const test::Heard& h : heard) {
        const auto frame = h.piece.kind == StreamKind::ubx ? parse_frame(h.piece.bytes) : std::nullopt;
        if (frame && frame->id.message_class != 0x01) found.push_back(h.piece.bytes);
    }
    return found;
}

std::vector<Bytes> answers_to_pieces(const std::string& board, const std::vector<Bytes>& pieces) {
    ReceiverRig rig(test::board_named(board));
    rig.run(1s);
    for (const Bytes& piece : pieces) {
        rig.write(piece);
        rig.run(2ms, 1ms);
    }
    rig.run(8s);
    return answers(rig, rig.heard());
}

TEST(ReceiverDialogue, IsTheSameHoweverItsBytesArrive) {
    RandomStream random(3, "dialogue");
    const Bytes all = joined(dialogue());
    for (const char* board : u_blox_boards) {
        const std::vector<Bytes> whole = answers_to_pieces(board, {all});
        ASSERT_GE(whole.size(), 10U) << board;
        std::vector<Bytes> single;
        for (const std::uint8_t byte : all)
            single.push_back({byte});
        EXPECT_EQ(answers_to_pieces(board, single), whole) << board;
        for (int attempt = 0; attempt < 5; ++attempt) {
            std::vector<Bytes> pieces;
            for (std::size_t at = 0; at < all.size();) {
                const std::size_t size = std::min<std::size_t>(all.size() - at, 1 + random.bits() % 40);
                pieces.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(at),
                                    all.begin() + static_cast<std::ptrdiff_t>(at + size));
                at += size;
            }
            EXPECT_EQ(answers_to_pieces(board, pieces), whole) << board;
        }
    }
}

// Garbage that holds no start of a frame's length that would swallow what follows: any bytes, and half frames.
TEST(ReceiverDialogue, SurvivesGarbageBetweenItsFrames) {
    RandomStream random(4, "garbage");
    for (const char* board : u_blox_boards) {
        const std::vector<Bytes> clean = answers_to_pieces(board, dialogue());
        for (int attempt = 0; attempt < 20; ++attempt) {
            std::vector<Bytes> pieces;
            for (const Bytes& frame : dialogue()) {
                Bytes garbage(random.bits() % 30);
                for (std::uint8_t& byte : garbage)
                    byte = static_cast<std::uint8_t>(random.bits());
                pieces.push_back(garbage);
                // What began and did not end is given up after a silence (RECEIVER.md 1.3).
                pieces.push_back(frame);
            }
            ReceiverRig rig(test::board_named(board));
            rig.run(1s);
            for (const Bytes& piece : pieces) {
                rig.write(piece);
                rig.run(2100ms);
            }
            rig.run(5s);
            EXPECT_EQ(answers(rig, rig.heard()), clean) << board << " attempt " << attempt;
        }
    }
}

TEST(ReceiverDialogue, NeverAnswersWhatIsDamaged) {
    RandomStream random(5, "damage");
    for (const char* board : u_blox_boards) {
        ReceiverRig rig(test::board_named(board));
        rig.run(1s);
        for (int attempt = 0; attempt < 300; ++attempt) {
            Bytes frame = dialogue()[random.bits() % 6];
            frame[2 + random.bits() % (frame.size() - 2)] ^= static_cast<std::uint8_t>(1 + random.bits() % 255);
            rig.write(frame);
            rig.run(2100ms, 50ms);
        }
        EXPECT_TRUE(answers(rig, rig.heard()).empty()) << board;
    }
}

// --- An hour at 10 Hz with a polling client ---

// Fast enough for the messages of the test, and set as that generation is.
void configure_for_endurance(ReceiverRig& rig, bool by_values) {
    if (by_values) {
        CfgValset set;
        set.layers = 1;
        set.pairs = {{0x40520001, 230400}, {0x30210001, 100}, {0x20910007, 1}, {0x20910016, 10}, {0x10740002, 0}};
        rig.send(set);
    } else {
        CfgPrt port;
        port.ports.push_back({1, 0, 0, 0x8D0, 230400, 0x07, 0x01, 0, {}});
        rig.send(port);
        rig.run(500ms);
        rig.send(CfgRate{100, 1, 1});
        rig.send(CfgMsgCurrentPort{0x01, 0x07, 1});
        rig.send(CfgMsgCurrentPort{0x01, 0x35, 10});
    }
    rig.run(2s);
    rig.heard().clear();
}

struct Poll {
    UbxMessageId id;
    Bytes payload;
    bool acknowledged;  ///< an ACK follows the answer
};

std::vector<Poll> endurance_polls(bool by_values) {
    std::vector<Poll> polls{{mon_ver, {}, false}, {nav_dop, {}, false}, {cfg_rate, {}, true}, {cfg_msg, {1, 7}, true}};
    CfgValgetPoll get;
    get.keys = {0x30210001, 0x20910007};
    if (by_values) polls.push_back({cfg_valget, encode_payload(get), true});
    return polls;
}

std::size_t heap_in_use() { return mallinfo2().uordblks; }

class Endurance : public testing::TestWithParam<const char*> {};

TEST_P(Endurance, MissesNoEpochAndNoPollInAnHourAtTenHertz) {
    ReceiverRig rig(test::board_named(GetParam()));
    const bool by_values = rig.receiver().board().quirks.value_config == firmware::ValueConfigSupport::full;
    configure_for_endurance(rig, by_values);
    const std::vector<Poll> polls = endurance_polls(by_values);

    std::vector<double> latencies;
    std::size_t epochs = 0, heap_early = 0;
    std::optional<std::uint32_t> last_tow;
    for (int second = 0; second < 3600; ++second) {
        const Poll& poll = polls[static_cast<std::size_t>(second) % polls.size()];
        rig.run(std::chrono::milliseconds(137 + second % 700), 1ms);
        const GpsTime asked = rig.now();
        // What was queued before it must leave first: ten bits a byte.
        const firmware::PortStatus port = rig.receiver().port_status(firmware::PortId::uart1);
        const double queued = 10.0 * static_cast<double>(port.pending) / rig.receiver().baud(firmware::PortId::uart1);
        rig.poll(poll.id, poll.payload);
        rig.run(1000ms - std::chrono::milliseconds(137 + second % 700), 1ms);
        std::optional<GpsTime> answered, acknowledged;
        for (const test::Heard& h : rig.heard()) {
            if (h.at > asked && h.is(poll.id)) answered = h.at;
            if (h.at > asked && h.is({0x05, 0x01})) acknowledged = h.at;
            const auto frame = h.piece.kind == StreamKind::ubx ? parse_frame(h.piece.bytes) : std::nullopt;
            const auto pvt = frame && frame->id == nav_pvt ? decode_payload<NavPvt>(frame->payload) : std::nullopt;
            if (!pvt) continue;
            if (last_tow) {
                ASSERT_EQ(pvt->i_tow, *last_tow + 100) << "second " << second;
            }
            last_tow = pvt->i_tow;
            ++epochs;
        }
        ASSERT_TRUE(answered) << "second " << second;
        ASSERT_EQ(acknowledged.has_value(), poll.acknowledged) << "second " << second;
        const auto total = std::chrono::duration<double>(acknowledged.value_or(*answered) - asked);
        latencies.push_back(total.count() - queued);
        rig.heard().clear();
        if (second == 300) heap_early = heap_in_use();
    }
    EXPECT_GE(epochs, 35990U);
    EXPECT_EQ(rig.receiver().port_totals(firmware::PortId::uart1).messages_dropped, 0U);
    std::sort(latencies.begin(), latencies.end());
    RecordProperty("p99_latency_us", static_cast<int>(latencies[latencies.size() * 99 / 100] * 1e6));
    EXPECT_LT(latencies[latencies.size() * 99 / 100], 0.050);
    // One epoch's worth of buffers may be in use at one look and not at the other.
    EXPECT_LT(static_cast<double>(heap_in_use()), static_cast<double>(heap_early) + 65536);
}

INSTANTIATE_TEST_SUITE_P(Boards, Endurance, testing::ValuesIn(u_blox_boards), [](const auto& instance) {
    std::string name = instance.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
});

// --- The same of receivers that are asked by sentences ---

struct SentenceDialogue {
    const char* board;
    std::vector<const char*> setup;
    const char* poll;
    const char* answer;  ///< how it begins
    std::uint32_t baud;
};

// GoogleTest shows the parameter, and CTest makes names of it.
void PrintTo(const SentenceDialogue& dialogue, std::ostream* out) { *out << dialogue.board; }

class SentenceEndurance : public testing::TestWithParam<SentenceDialogue> {};

Bytes sentence_of(std::string_view body) { return to_bytes(Sentence(body).finish()); }

TEST_P(SentenceEndurance, MissesNoEpochAndNoPollInAnHourAtTenHertz) {
    const SentenceDialogue& dialogue = GetParam();
    firmware::BoardProfile board = test::board_named(dialogue.board);
    board.baud = dialogue.baud;
    ReceiverRig rig(std::move(board));
    for (const char* body : dialogue.setup) {
        rig.write(sentence_of(body));
        rig.run(200ms);
    }
    rig.run(2s);
    ASSERT_EQ(rig.receiver().settings().navigation_period, 100ms);
    rig.heard().clear();
    std::size_t epochs = 0, unanswered = 0, heap_early = 0;
    for (int second = 0; second < 3600; ++second) {
        rig.run(std::chrono::milliseconds(second % 100), 1ms);
        rig.write(sentence_of(dialogue.poll));
        rig.run(std::chrono::milliseconds(1000 - second % 100), 1ms);
        bool answered = false;
        for (const test::Heard& h : rig.heard()) {
            ASSERT_EQ(h.piece.kind, StreamKind::nmea) << "second " << second;
            const std::string line = to_string(h.piece.bytes);
            answered |= line.starts_with(dialogue.answer);
            epochs += line.substr(3, 3) == "RMC" ? 1U : 0U;
        }
        unanswered += answered ? 0U : 1U;
        rig.heard().clear();
        if (second == 300) heap_early = heap_in_use();
    }
    EXPECT_GE(epochs, 35998U);
    EXPECT_LE(epochs, 36002U);
    EXPECT_EQ(unanswered, 0U);
    EXPECT_LT(static_cast<double>(heap_in_use()), static_cast<double>(heap_early) + 65536);
}

INSTANTIATE_TEST_SUITE_P(
    Boards, SentenceEndurance,
    testing::Values(SentenceDialogue{"mtk3339",
                                     {"PMTK220,100", "PMTK314,0,1,0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0"},
                                     "PMTK605",
                                     "$PMTK705,",
                                     115200},
                    SentenceDialogue{"airoha-ag33xx", {"PAIR050,100"}, "PAIR020", "$PAIR020,", 460800}),
    [](const auto& instance) {
        std::string name = instance.param.board;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    });

}  // namespace
}  // namespace skyloop
