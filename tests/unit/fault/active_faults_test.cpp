#include "skyloop/fault/active_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "receiver_bench.hpp"

namespace skyloop::fault_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

GpsTime second_of_faults(double s) { return advanced(to_gps_time(2300, 0), Seconds(s)); }

// What happens to the speed of the receiver: "9600", "back to 9600", "0" for that of before.
class SpeedsOfFaults {
public:
    void begin(std::size_t entry, double baud, double s) {
        faults_.begin(*make_fault("changed_baud", {{"baud", baud}}), {entry, 1, second_of_faults(s)});
    }
    void end(std::size_t entry, double s) { faults_.end(entry, 1, second_of_faults(s)); }
    std::vector<std::string> settled(double s) {
        std::vector<std::string> speeds;
        for (const firmware::ReceiverEvent& event : faults_.settle(second_of_faults(s))) {
            const auto& forced = std::get<firmware::ForceBaud>(event);
            speeds.push_back((forced.given_back ? "back to " : "") + std::to_string(forced.baud));
        }
        return speeds;
    }

private:
    ActiveFaults faults_;
};

TEST(ActiveFaults, LeaveTheLineAtTheSpeedOfTheYoungest) {
    SpeedsOfFaults first_ends_first;
    first_ends_first.begin(0, 9600, 10);
    first_ends_first.begin(1, 19200, 20);
    EXPECT_THAT(first_ends_first.settled(20), ElementsAre("9600", "19200"));
    first_ends_first.end(0, 30);
    EXPECT_THAT(first_ends_first.settled(30), IsEmpty());
    first_ends_first.end(1, 40);
    EXPECT_THAT(first_ends_first.settled(40), ElementsAre("0"));

    SpeedsOfFaults last_ends_first;
    last_ends_first.begin(0, 9600, 10);
    last_ends_first.begin(1, 19200, 20);
    EXPECT_THAT(last_ends_first.settled(20), ElementsAre("9600", "19200"));
    last_ends_first.end(1, 30);
    EXPECT_THAT(last_ends_first.settled(30), ElementsAre("back to 9600"));
    last_ends_first.end(0, 40);
    EXPECT_THAT(last_ends_first.settled(40), ElementsAre("0"));
}

}  // namespace
}  // namespace skyloop::fault_test
