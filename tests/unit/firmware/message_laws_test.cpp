#include <gtest/gtest.h>

#include "receiver/protocol/ubx_messages.hpp"
#include "support/ubx_message_types.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

bool is_made_here(UbxMessageId message) {
    switch (message.message_class) {
        case 0x01:
        case 0x02:
        case 0x0A:
        case 0x0D:
        case 0x27:
            return true;
        default:
            return false;
    }
}

// Every message of every generation, in each state, is a whole frame that reads and writes to the same bytes.
TEST(EveryMessage, ReadsBackAsItWasMade) {
    for (const int generation : {6, 7, 8, 9, 10}) {
        UbxReport fixed(generation), cold(generation), lost(generation);
        cold.start_cold(7);
        lost.lose_fix();
        int made = 0;
        for (const UbxMessage& message : ubx_messages()) {
            if (!is_made_here(message.id)) continue;
            for (const UbxReport* report : {&fixed, &cold, &lost}) {
                for (const Bytes& bytes : report->frames(message.id)) {
                    const auto frame = parse_frame(bytes);
                    ASSERT_TRUE(frame) << message.name;
                    EXPECT_EQ(frame->id, message.id) << message.name;
                    EXPECT_EQ(UbxOutputTypes::written_again(*frame), bytes) << message.name;
                    ++made;
                }
            }
        }
        EXPECT_GT(made, 3 * 45) << generation;
    }
}

// RECEIVER.md 3.1, 3.2: no message of those tables is left out but those that a pin or a base station sets off.
TEST(EveryMessage, OfTheSpecificationIsMade) {
    const UbxReport f9(9);
    for (const char* name :
         {"NAV-PVT",       "NAV-POSECEF", "NAV-POSLLH",    "NAV-STATUS",   "NAV-DOP",     "NAV-SOL",
          "NAV-VELECEF",   "NAV-VELNED",  "NAV-HPPOSECEF", "NAV-HPPOSLLH", "NAV-TIMEGPS", "NAV-TIMEUTC",
          "NAV-CLOCK",     "NAV-TIMEGAL", "NAV-TIMEBDS",   "NAV-TIMEGLO",  "NAV-TIMELS",  "NAV-TIMEQZSS",
          "NAV-SVINFO",    "NAV-SAT",     "NAV-SIG",       "NAV-COV",      "NAV-ODO",     "NAV-ORB",
          "NAV-SBAS",      "NAV-DGPS",    "NAV-RELPOSNED", "NAV-SVIN",     "NAV-EOE",     "NAV-GEOFENCE",
          "NAV-AOPSTATUS", "NAV-SLAS",    "NAV-PL",        "MON-VER",      "MON-HW",      "MON-HW2",
          "MON-RF",        "MON-COMMS",   "MON-TXBUF",     "MON-RXBUF",    "MON-GNSS",    "MON-HW3",
          "MON-SYS",       "MON-IO",      "MON-MSGPP",     "MON-PATCH",    "MON-RXR",     "MON-SPAN",
          "RXM-RAWX",      "RXM-MEASX",   "RXM-SVSI",      "TIM-TP",       "SEC-UNIQID",  "SEC-SIG",
          "SEC-SIGLOG"}) {
        const auto id = ubx_message_from_name(name);
        ASSERT_TRUE(id) << name;
        EXPECT_EQ(f9.frames(*id).size(), 1u) << name;
    }
}

}  // namespace
}  // namespace skyloop::firmware
