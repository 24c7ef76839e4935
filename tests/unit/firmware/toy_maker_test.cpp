// A new maker is one folder and one row.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_epochs.hpp"
#include "toy_maker/toy_maker.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class ToyReceiver : public testing::Test {
protected:
    ToyReceiver() { receiver_.start(now_); }
    void send(const std::string& body) { receiver_.input(PortId::uart1, to_bytes(Sentence(body).finish()), now_); }
    // Until so much later, with an epoch at its end.
    std::string run(Nanoseconds length) {
        now_ += length;
        Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
        fix.time = now_;
        add_satellites(fix, Constellation::gps, 1, 4);
        std::string heard;
        const auto take = [&] {
            for (const Receiver::Sent& sent : receiver_.output(now_))
                heard += to_string(sent.bytes);
        };
        take();
        receiver_.on_epoch({fix});
        now_ += 200ms;
        take();
        return heard;
    }
    GpsTime now_ = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500).time;
    Receiver receiver_{sample_board(NmeaVersion::v4_10, {Constellation::gps}), {}, toy_row};
};

TEST_F(ToyReceiver, SendsItsOwnMessagesAndTakesItsOwnCommands) {
    EXPECT_THAT(run(800ms), HasSubstr("$PTOY,FIX,3*"));
    send("PTOY,RATE,200");
    EXPECT_THAT(run(300ms), HasSubstr("$PTOY,OK*"));
    EXPECT_EQ(receiver_.settings().navigation_period, 200ms);
    send("PTOY,RATE,x");
    EXPECT_THAT(run(300ms), HasSubstr("$PTOY,NO*"));
    EXPECT_EQ(receiver_.settings().navigation_period, 200ms);
}

TEST_F(ToyReceiver, RestartsAsTheCoreHasIt) {
    send("PTOY,RATE,200");
    receiver_.happen(Reboot{}, now_);
    EXPECT_EQ(receiver_.settings().navigation_period, 1s);
    EXPECT_EQ(receiver_.settings().restarts, 1);
    EXPECT_FALSE(receiver_.configure({{1, 2}})) << "configuration items are u-blox's";
}

}  // namespace
}  // namespace skyloop::firmware
