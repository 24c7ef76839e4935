// What sentences of clients do (RECEIVER.md 5.7 to 5.9).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/makers.hpp"
#include "firmware/ublox/ublox.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {
namespace {

using enum Constellation;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

BoardProfile commanded_board(MakerKind kind) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps, sbas, glonass});
    board.maker = kind;
    board.ports = {PortId::i2c, PortId::uart1, PortId::usb};
    board.baud = 9600;
    board.max_rate_hz = 10;
    board.identity.version_answers = {"$PMTK705,AXN_2.51_3339_19071200,0002,QUECTEL-L70,1.0",
                                      "$PQVERNO,R,L70BGR03A05S,2019/10/09,21:12", "$PAIR020,AG3352,1.2",
                                      "$PAIR021,AG3352,3.4"};
    return board;
}

// A maker's settings, and what sentences do to them.
struct Commanded {
    explicit Commanded(MakerKind kind) : Commanded(commanded_board(kind)) {}
    explicit Commanded(BoardProfile profile)
        : board(std::move(profile)), maker(maker_row(board.maker).make(board, {})) {}
    Commanded(const Commanded&) = delete;

    // A client's sentence, without checksum.
    CommandOutcome execute(const std::string& body) {
        const NavigationState state;
        return maker->receive({StreamKind::nmea, to_bytes(Sentence(body).finish())},
                              {PortId::uart1, {}, FirmwareFaults{}, state.time, {board, maker->config(), state}});
    }
    std::vector<std::string> answers(const std::string& body) {
        std::vector<std::string> lines;
        for (const Bytes& bytes : execute(body).answers)
            lines.push_back(to_string(bytes));
        return lines;
    }
    std::optional<StartKind> start_by(const std::string& body) {
        const CommandOutcome outcome = execute(body);
        return outcome.reset ? std::optional(outcome.reset->forgotten.kind()) : std::nullopt;
    }
    // Every how many epochs UART1 sends a sentence, as the battery keeps it; the board sends each with every epoch.
    [[nodiscard]] int rate(const std::string& name) const {
        const std::string text = maker->stored_text(), line = "battery " + name + "_uart1 ";
        const std::size_t at = text.find(line);
        return at == std::string::npos ? 1 : std::stoi(text.substr(at + line.size()));
    }
    [[nodiscard]] const ReceiverConfig& config() const { return maker->config(); }
    [[nodiscard]] std::uint32_t baud() const { return config().port(PortId::uart1).baud; }
    [[nodiscard]] std::int64_t period_ms() const {
        return config().settings.navigation_period / std::chrono::milliseconds(1);
    }
    BoardProfile board;
    std::unique_ptr<Maker> maker;
};

// A u-blox's configuration, and what PUBX does to it.
struct PubxReceiver {
    explicit PubxReceiver(BoardProfile profile = commanded_board(MakerKind::ublox))
        : board(std::move(profile)), config(factory_config(board)) {}
    SentenceOutcome execute(const std::string& body) {
        const std::string text = Sentence(body).finish();
        return execute_ublox(*parse_sentence(text), board, config);
    }
    [[nodiscard]] int rate(std::string_view name, PortId port = PortId::uart1) const {
        return config.rate(find_output_message(name)->id, port);
    }
    BoardProfile board;
    ConfigStore config;
};

TEST(MuteReceiver, AnswersNothing) {
    Commanded receiver(MakerKind::mute);
    for (const char* body : {"PUBX,00", "EIGPQ,RMC", "PMTK605", "PAIR020", "PGRMCE", "PUBX,41,1,0003,0001,115200,0"}) {
        EXPECT_THAT(receiver.answers(body), IsEmpty());
    }
    EXPECT_EQ(receiver.baud(), 9600U);
}

TEST(PubxCommands, PollSentences) {
    PubxReceiver receiver;
    using Ids = std::vector<UbxMessageId>;
    EXPECT_EQ(receiver.execute("PUBX,00").polled, (Ids{{0xF1, 0}}));
    EXPECT_EQ(receiver.execute("PUBX,03").polled, (Ids{{0xF1, 3}}));
    EXPECT_EQ(receiver.execute("PUBX,04").polled, (Ids{{0xF1, 4}}));
    EXPECT_THAT(receiver.execute("PUBX,05").polled, IsEmpty());
    EXPECT_THAT(receiver.execute("PUBX,00,1").polled, IsEmpty());
    for (const char* poll : {"EIGPQ,RMC", "XXGNQ,RMC", "GPGLQ,RMC", "EIGBQ,RMC", "EIGAQ,RMC", "EIGQQ,RMC"})
        EXPECT_EQ(receiver.execute(poll).polled, (Ids{{0xF0, 4}})) << poll;
    EXPECT_THAT(receiver.execute("EIGPQ,XYZ").polled, IsEmpty());
    EXPECT_THAT(receiver.execute("EIGPQ,NAV-PVT").polled, IsEmpty());
    EXPECT_THAT(receiver.execute("EIGXQ,RMC").polled, IsEmpty());
    receiver.board.messages = {{0xF0, 0}};
    EXPECT_THAT(receiver.execute("EIGPQ,RMC").polled, IsEmpty());
    receiver.board.polled = {{0xF0, 4}};
    EXPECT_EQ(receiver.execute("EIGPQ,RMC").polled, (Ids{{0xF0, 4}}));
}

TEST(PubxCommands, SetRatesOfEachPort) {
    PubxReceiver receiver;
    EXPECT_THAT(receiver.execute("PUBX,40,GLL,0,0,0,0,0,0").polled, IsEmpty());
    EXPECT_EQ(receiver.rate("GLL"), 0);
    EXPECT_EQ(receiver.rate("GLL", PortId::usb), 0);
    receiver.execute("PUBX,40,ZDA,1,2,3,4,5,0");
    EXPECT_EQ(receiver.rate("ZDA", PortId::i2c), 1);
    EXPECT_EQ(receiver.rate("ZDA", PortId::uart1), 2);
    EXPECT_EQ(receiver.rate("ZDA", PortId::usb), 4);
    EXPECT_FALSE(receiver.config.has(*rate_key({0xF0, 8}, PortId::spi)));
    const std::uint64_t before = receiver.config.revision();
    receiver.execute("PUBX,40,XYZ,1,1,1,1,1,0");
    receiver.execute("PUBX,40,GGA,x,1,1,1,1,0");
    receiver.execute("PUBX,40,GGA,0,-1,0,0,0,0");
    receiver.execute("PUBX,40,GGA,0,256,0,0,0,0");
    receiver.execute("PUBX,40,GGA,0");
    receiver.execute("PUBX,40");
    EXPECT_EQ(receiver.config.revision(), before);
}

// The four rates that sketches for Arduino and trackers of balloons send; those of the ports after USB stay.
TEST(PubxCommands, SetRatesWithoutThePortsAfterUsb) {
    BoardProfile board = commanded_board(MakerKind::ublox);
    board.ports = {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb, PortId::spi};
    PubxReceiver receiver(board);
    receiver.execute("PUBX,40,GLL,0,0,0,0");
    for (const PortId port : {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb})
        EXPECT_EQ(receiver.rate("GLL", port), 0);
    EXPECT_EQ(receiver.rate("GLL", PortId::spi), 1);
    receiver.execute("PUBX,40,ZDA,0,1,0,0");
    EXPECT_EQ(receiver.rate("ZDA"), 1);
    receiver.execute("PUBX,40,RMC,0,0,0,0,0");
    EXPECT_EQ(receiver.rate("RMC", PortId::spi), 0);
    const std::uint64_t before = receiver.config.revision();
    receiver.execute("PUBX,40,GGA,0,0,0");
    receiver.execute("PUBX,40,GGA,0,0,0,");
    EXPECT_EQ(receiver.config.revision(), before);
}

// The strings of RECEIVER.md 5.7.
TEST(PubxCommands, SetPortsAsDriversDo) {
    PubxReceiver receiver;
    const auto in = [&](std::uint32_t p) { return receiver.config.flag(key::in_protocol(PortId::uart1, p)); };
    const auto out = [&](std::uint32_t p) { return receiver.config.flag(key::out_protocol(PortId::uart1, p)); };
    EXPECT_THAT(receiver.execute("PUBX,41,1,0003,0001,115200,0").polled, IsEmpty());
    EXPECT_EQ(receiver.config.value(key::uart1_baudrate), 115200U);
    EXPECT_TRUE(in(1) && in(2) && !in(4));
    EXPECT_FALSE(receiver.config.flag(0x10FD0021)) << "RTCM 2, which the mask does not name";
    EXPECT_TRUE(out(1) && !out(2) && !out(4));
    receiver.execute("PUBX,41,1,0023,0003,230400,0");
    EXPECT_EQ(receiver.config.value(key::uart1_baudrate), 230400U);
    EXPECT_TRUE(in(1) && in(2) && in(4) && out(1) && out(2));
    const std::uint64_t before = receiver.config.revision();
    for (const char* bad :
         {"PUBX,41,1,0003,0001,0,0", "PUBX,41,1,000G,0001,9600,0", "PUBX,41,7,0003,0001,9600,0",
          "PUBX,41,2,0003,0001,9600,0", "PUBX,41,1,0003,0001", "PUBX,41", "PUBX,41,1,00003,0001,9600,0"})
        receiver.execute(bad);
    EXPECT_EQ(receiver.config.revision(), before);
    receiver.board.bauds = {9600, 115200};
    receiver.execute("PUBX,41,1,0003,0003,57600,0");
    EXPECT_EQ(receiver.config.value(key::uart1_baudrate), 230400U);
    receiver.execute("PUBX,41,3,0001,0001,0,0");  // USB has no speed
    EXPECT_FALSE(receiver.config.flag(key::out_protocol(PortId::usb, 2)));
}

// Captures in RECEIVER.md 1.4.
TEST(UnknownSentences, AreNamedByM8Alone) {
    Commanded receiver(MakerKind::ublox);
    EXPECT_THAT(receiver.answers("PGRMCE"), IsEmpty());
    receiver.board.quirks.answers_unknown_nmea = true;
    EXPECT_THAT(receiver.answers("PGRMCE"), ElementsAre("$GNTXT,01,01,01,PGRM inv format*2A\r\n"));
    EXPECT_THAT(receiver.answers("PASHQ,RID"), ElementsAre(Sentence("GNTXT,01,01,01,PASH inv format").finish()));
    EXPECT_THAT(receiver.answers("PMTK605"), ElementsAre(Sentence("GNTXT,01,01,01,PMTK inv format").finish()));
    EXPECT_THAT(receiver.answers("PFEC,GPint"), ElementsAre(Sentence("GNTXT,01,01,01,PFEC inv format").finish()));
    EXPECT_THAT(receiver.answers("GPGGA,1"), IsEmpty());
    EXPECT_THAT(receiver.answers("PUBX,99"), IsEmpty());
    ASSERT_TRUE(receiver.maker->configure({{key::inf_nmea(PortId::uart1), 0x05}}));
    EXPECT_THAT(receiver.answers("PGRMCE"), IsEmpty());
}

TEST(PmtkCommands, AnswerAsRecorded) {
    Commanded receiver(MakerKind::mtk);
    EXPECT_THAT(receiver.answers("PMTK000"), ElementsAre("$PMTK001,0,3*30\r\n"));
    EXPECT_THAT(receiver.answers("PMTK220,200"), ElementsAre("$PMTK001,220,3*30\r\n"));
    EXPECT_THAT(receiver.answers("PMTK300,1000,0,0,0,0"), ElementsAre("$PMTK001,300,3*33\r\n"));
    EXPECT_THAT(receiver.answers("PMTK301,2"), ElementsAre("$PMTK001,301,3*32\r\n"));
    EXPECT_THAT(receiver.answers("PMTK313,1"), ElementsAre("$PMTK001,313,3*31\r\n"));
    EXPECT_THAT(receiver.answers("PMTK424"), ElementsAre("$PMTK001,424,1*30\r\n"));
    EXPECT_THAT(receiver.answers("PMTK604"), ElementsAre("$PMTK001,604,1*30\r\n"));
    EXPECT_THAT(receiver.answers("PMTK605"),
                ElementsAre("$PMTK705,AXN_2.51_3339_19071200,0002,QUECTEL-L70,1.0*32\r\n"));
    EXPECT_THAT(receiver.answers("PQVERNO,R"), ElementsAre("$PQVERNO,R,L70BGR03A05S,2019/10/09,21:12*23\r\n"));
    for (const char* other : {"PMTKx", "PMTK", "PMTK1000", "PUBX,00", "EIGPQ,RMC", "PGRMCE"})
        EXPECT_THAT(receiver.answers(other), IsEmpty()) << other;
}

TEST(PmtkCommands, SetTheInterval) {
    Commanded receiver(MakerKind::mtk);
    receiver.execute("PMTK220,200");
    EXPECT_EQ(receiver.period_ms(), 200);
    EXPECT_THAT(receiver.answers("PMTK400"),
                ElementsAre(Sentence("PMTK001,400,3").finish(), Sentence("PMTK500,200,0,0,0.0,0.0").finish()));
    receiver.board.max_rate_hz = 5;  // the old 3329
    EXPECT_THAT(receiver.answers("PMTK220,100"), ElementsAre(Sentence("PMTK001,220,2").finish()));
    for (const char* bad : {"PMTK220,50", "PMTK220,10001", "PMTK220,x", "PMTK220"})
        EXPECT_THAT(receiver.answers(bad), ElementsAre(Sentence("PMTK001,220,0").finish())) << bad;
    EXPECT_EQ(receiver.period_ms(), 200);
    receiver.maker->restart(false);  // what a restart does
    EXPECT_EQ(receiver.period_ms(), 200);
}

TEST(PmtkCommands, SetTheSpeed) {
    Commanded receiver(MakerKind::mtk);
    EXPECT_THAT(receiver.answers("PMTK251,38400"), IsEmpty());
    EXPECT_EQ(receiver.baud(), 38400U);
    EXPECT_THAT(receiver.answers("PMTK251,0"), IsEmpty());
    EXPECT_EQ(receiver.baud(), 9600U);
    receiver.board.bauds = {9600, 115200};
    EXPECT_THAT(receiver.answers("PMTK251,12345"), ElementsAre(Sentence("PMTK001,251,0").finish()));
    EXPECT_EQ(receiver.baud(), 9600U);
}

TEST(PmtkCommands, SetTheSentences) {
    Commanded receiver(MakerKind::mtk);
    EXPECT_THAT(receiver.answers("PMTK314,0,1,0,5,0,0,0,0,0,0,0,0,0,0,0,0,0,2,0"),
                ElementsAre("$PMTK001,314,3*36\r\n"));
    EXPECT_EQ(receiver.rate("RMC"), 1);
    EXPECT_EQ(receiver.rate("GGA"), 5);
    EXPECT_EQ(receiver.rate("ZDA"), 2);
    EXPECT_EQ(receiver.rate("GLL"), 0);
    EXPECT_THAT(receiver.answers("PMTK414"),
                ElementsAre(Sentence("PMTK001,414,3").finish(),
                            Sentence("PMTK514,0,1,0,5,0,0,0,0,0,0,0,0,0,0,0,0,0,2,0").finish()));
    for (const char* bad : {"PMTK314,0,1", "PMTK314,0,1,0,6,0,0,0,0,0,0,0,0,0,0,0,0,0,2,0", "PMTK314",
                            "PMTK314,0,1,0,5,0,0,0,0,0,0,0,0,0,0,0,0,0,2,0,0"})
        EXPECT_THAT(receiver.answers(bad), ElementsAre(Sentence("PMTK001,314,0").finish())) << bad;
    EXPECT_EQ(receiver.rate("GGA"), 5);
    receiver.execute("PMTK314,-1");
    EXPECT_EQ(receiver.rate("GGA"), 1);
    EXPECT_EQ(receiver.rate("GLL"), 1);
}

TEST(PmtkCommands, SetCorrectionsAndSystems) {
    Commanded receiver(MakerKind::mtk);
    const auto source = [&] { return receiver.answers("PMTK401").at(1); };
    receiver.execute("PMTK301,0");
    EXPECT_EQ(source(), Sentence("PMTK501,0").finish());
    receiver.execute("PMTK301,1");
    EXPECT_EQ(source(), Sentence("PMTK501,1").finish());
    receiver.execute("PMTK301,2");
    EXPECT_EQ(source(), Sentence("PMTK501,2").finish());
    EXPECT_THAT(receiver.answers("PMTK301,3"), ElementsAre(Sentence("PMTK001,301,0").finish()));
    receiver.execute("PMTK313,0");
    EXPECT_EQ(receiver.answers("PMTK413").at(1), Sentence("PMTK513,0").finish());
    EXPECT_FALSE(receiver.config().has_on(sbas));
    EXPECT_THAT(receiver.answers("PMTK353,1,1,1,0,0"), ElementsAre(Sentence("PMTK001,353,3,1,1,1,0,0").finish()));
    EXPECT_TRUE(receiver.config().has_on(galileo));
    EXPECT_THAT(receiver.answers("PMTK353,0,0,0,0,0"), ElementsAre(Sentence("PMTK001,353,2").finish()));
    EXPECT_TRUE(receiver.config().has_on(galileo));
    EXPECT_THAT(receiver.answers("PMTK386,0.4"), ElementsAre(Sentence("PMTK001,386,3").finish()));
    EXPECT_EQ(receiver.config().limits.held_below, MetresPerSecond(0.4));
    EXPECT_THAT(receiver.answers("PMTK397,9"), ElementsAre(Sentence("PMTK001,397,0").finish()));
    EXPECT_THAT(receiver.answers("PMTK161,0"), ElementsAre(Sentence("PMTK001,161,3").finish()));
    EXPECT_TRUE(receiver.execute("PMTK161,1").sleep);
    for (const char* wrong : {"PMTK161", "PMTK161,2", "PMTK161,x"})
        EXPECT_FALSE(receiver.execute(wrong).sleep) << wrong;
    EXPECT_THAT(receiver.answers("PMTK869,1,1"), ElementsAre(Sentence("PMTK001,869,3").finish()));
}

TEST(PmtkCommands, RestartWithoutAnswer) {
    Commanded receiver(MakerKind::mtk);
    receiver.execute("PMTK220,200");
    const auto restart = [&](const char* body) {
        EXPECT_THAT(receiver.answers(body), IsEmpty());
        return receiver.start_by(body);
    };
    EXPECT_EQ(restart("PMTK101"), StartKind::hot);
    EXPECT_EQ(restart("PMTK102"), StartKind::warm);
    EXPECT_EQ(restart("PMTK103"), StartKind::cold);
    EXPECT_EQ(receiver.period_ms(), 200);
    EXPECT_EQ(restart("PMTK104"), StartKind::cold);
    EXPECT_EQ(receiver.period_ms(), 1000);
}

TEST(PairCommands, AnswerAndSet) {
    Commanded receiver(MakerKind::airoha);
    EXPECT_THAT(receiver.answers("PAIR002"), ElementsAre(Sentence("PAIR001,002,0").finish()));
    EXPECT_EQ(receiver.execute("PAIR002").navigating, true);
    EXPECT_EQ(receiver.execute("PAIR003").navigating, false);
    EXPECT_THAT(receiver.answers("PAIR020"),
                ElementsAre(Sentence("PAIR001,020,0").finish(), Sentence("PAIR020,AG3352,1.2").finish()));
    EXPECT_THAT(receiver.answers("PAIR021"),
                ElementsAre(Sentence("PAIR001,021,0").finish(), Sentence("PAIR021,AG3352,3.4").finish()));
    EXPECT_THAT(receiver.answers("PAIR050,100"), ElementsAre(Sentence("PAIR001,050,0").finish()));
    EXPECT_EQ(receiver.period_ms(), 100);
    EXPECT_EQ(receiver.answers("PAIR051").at(1), Sentence("PAIR051,100").finish());
    EXPECT_THAT(receiver.answers("PAIR050,20"), ElementsAre(Sentence("PAIR001,050,2").finish()));
    receiver.execute("PAIR062,1,0");
    EXPECT_EQ(receiver.rate("GLL"), 0);
    receiver.execute("PAIR062,9,3");
    EXPECT_EQ(receiver.rate("GNS"), 3);
    EXPECT_EQ(receiver.answers("PAIR063,9").at(1), Sentence("PAIR063,9,3").finish());
    EXPECT_THAT(receiver.answers("PAIR062,10,1"), ElementsAre(Sentence("PAIR001,062,2").finish()));
    EXPECT_THAT(receiver.answers("PAIR063"), ElementsAre(Sentence("PAIR001,063,2").finish()));
    EXPECT_THAT(receiver.answers("PAIR062,-2,1"), ElementsAre(Sentence("PAIR001,062,2").finish()));
    EXPECT_THAT(receiver.answers("PAIR062,-1,0"), ElementsAre(Sentence("PAIR001,062,0").finish()));
    for (const char* sentence : {"GGA", "GLL", "GSV", "RMC", "GNS"})
        EXPECT_EQ(receiver.rate(sentence), 0) << sentence;
    receiver.execute("PAIR062,0,1");
    const auto told = receiver.answers("PAIR063,-1");
    ASSERT_EQ(told.size(), 11U);
    EXPECT_EQ(told.at(1), Sentence("PAIR063,0,1").finish());
    EXPECT_EQ(told.at(10), Sentence("PAIR063,9,0").finish());
    receiver.execute("PAIR080,5");
    EXPECT_EQ(receiver.config().limits.dynamic_model, 8);
    EXPECT_THAT(receiver.answers("PAIR080,2"), ElementsAre(Sentence("PAIR001,080,2").finish()));
    receiver.execute("PAIR410,0");
    EXPECT_FALSE(receiver.config().has_on(sbas));
    receiver.execute("PAIR400,2");
    EXPECT_TRUE(receiver.config().has_on(sbas));
    EXPECT_THAT(receiver.answers("PAIR999"), ElementsAre(Sentence("PAIR001,999,3").finish()));
    EXPECT_THAT(receiver.answers("PAIRx"), IsEmpty());
    EXPECT_THAT(receiver.answers("PMTK605"), IsEmpty());
}

TEST(PairCommands, KeepSpeedAndSystemsForTheNextStart) {
    Commanded receiver(MakerKind::airoha);
    EXPECT_THAT(receiver.answers("PAIR864,0,0,115200"), ElementsAre(Sentence("PAIR001,864,0").finish()));
    EXPECT_THAT(receiver.answers("PAIR066,1,0,1,0,0,0"), ElementsAre(Sentence("PAIR001,066,0").finish()));
    EXPECT_THAT(receiver.answers("PAIR066,0,0,0,0,0,0"), ElementsAre(Sentence("PAIR001,066,2").finish()));
    EXPECT_THAT(receiver.answers("PAIR864,1,0,9600"), ElementsAre(Sentence("PAIR001,864,2").finish()));
    EXPECT_EQ(receiver.baud(), 9600U);
    EXPECT_TRUE(receiver.config().has_on(glonass));
    EXPECT_EQ(receiver.start_by("PAIR004"), StartKind::hot);
    EXPECT_EQ(receiver.baud(), 9600U) << "the acknowledgement is still to leave";
    receiver.maker->restart(false);
    EXPECT_EQ(receiver.baud(), 115200U);
    EXPECT_FALSE(receiver.config().has_on(glonass));
    EXPECT_TRUE(receiver.config().has_on(galileo));
    EXPECT_EQ(receiver.start_by("PAIR005"), StartKind::warm);
    EXPECT_EQ(receiver.start_by("PAIR006"), StartKind::cold);
    EXPECT_EQ(receiver.start_by("PAIR007"), StartKind::cold);
    receiver.maker->restart(false);
    EXPECT_EQ(receiver.baud(), 9600U);
}

TEST(PairCommands, SaveForGood) {
    Commanded receiver(MakerKind::airoha);
    receiver.execute("PAIR050,200");
    receiver.execute("PAIR513");
    receiver.maker->lose_battery();
    receiver.maker->restart(false);
    EXPECT_EQ(receiver.period_ms(), 200);
    receiver.execute("PAIR050,1000");
    receiver.execute("PAIR864,0,0,115200");
    receiver.execute("PAIR513");
    receiver.maker->lose_battery();
    receiver.maker->restart(false);
    EXPECT_EQ(receiver.period_ms(), 1000);
    EXPECT_EQ(receiver.baud(), 115200U);
}

}  // namespace
}  // namespace skyloop::firmware
