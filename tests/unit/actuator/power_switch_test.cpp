// A run's switch: it never keeps the loop waiting, tells what failed, and leaves the power on.
#include "wire/actuator/power_switch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <semaphore>

#include "told_orders.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// What a test sees of its hardware; outlives the switch.
struct Hardware {
    std::mutex mutex;
    std::vector<std::string> orders;
    std::string name;  // by which it is locked
    int opened = 0;
    int failing_cuts = 0, failing_restores = 0, failing_opens = 0;  // of the next
    std::atomic<bool> slow{false};
    std::atomic<bool> comes_back{false};  // its state is on, whatever it was told
    std::atomic<int> begun{0};            // orders
    std::counting_semaphore<> go{0};      // a slow order waits for it

    Result<void> carry_out(const std::string& order, int& failing) {
        ++begun;
        if (slow) go.acquire();
        const std::lock_guard lock(mutex);
        if (failing > 0) {
            --failing;
            return fail(ErrorCode::outside, "no answer in time");
        }
        orders.push_back(order);
        return {};
    }
    std::vector<std::string> seen() {
        const std::lock_guard lock(mutex);
        return orders;
    }
};

class PlayedActuator : public Actuator {
public:
    explicit PlayedActuator(Hardware& hardware) : hardware_(hardware) {}
    Result<void> cut() override { return hardware_.carry_out("cut", hardware_.failing_cuts); }
    Result<void> restore() override { return hardware_.carry_out("on", hardware_.failing_restores); }
    Result<std::optional<PowerState>> state() override {
        return hardware_.comes_back ? std::optional(PowerState::on) : std::nullopt;
    }
    [[nodiscard]] std::string description() const override { return "a played relay"; }
    [[nodiscard]] std::string lock_name() const override { return hardware_.name; }

private:
    Hardware& hardware_;
};

Result<std::unique_ptr<PowerSwitch>> switch_on(Hardware& hardware) {
    return PowerSwitch::start({"relay:0000:0000/1", [&]() -> Result<std::unique_ptr<Actuator>> {
                                   const std::lock_guard lock(hardware.mutex);
                                   ++hardware.opened;
                                   if (hardware.failing_opens-- > 0) return fail(ErrorCode::outside, "it is gone");
                                   return std::make_unique<PlayedActuator>(hardware);
                               }});
}

TEST(PowerSwitch, BeginsWithThePowerOnAndFollows) {
    Hardware hardware;
    const auto power = switch_on(hardware);
    ASSERT_TRUE(power);
    EXPECT_THAT(hardware.seen(), ElementsAre("on"));
    (*power)->want(PowerState::on);  // it is
    (*power)->want(PowerState::cut);
    (*power)->want(PowerState::cut);
    EXPECT_TRUE(eventually([&] { return hardware.seen().size() == 2; }));
    (*power)->want(PowerState::on);
    EXPECT_TRUE(eventually([&] { return (*power)->counts().restores == 1; }));
    (*power)->finish();
    EXPECT_THAT(hardware.seen(), ElementsAre("on", "cut", "on")) << "known to be on: nothing is left to restore";
    const PowerCounts counts = (*power)->counts();
    EXPECT_EQ(counts.cuts, 1U);
    EXPECT_EQ(counts.restores, 1U);
    EXPECT_EQ(counts.failures, 0U);
    EXPECT_THAT((*power)->take_news(), IsEmpty());
    EXPECT_EQ((*power)->description(), "a played relay");
}

TEST(PowerSwitch, RestoresWhatIsCutWhenItGoes) {
    Hardware hardware;
    {
        const auto power = switch_on(hardware);
        ASSERT_TRUE(power);
        (*power)->want(PowerState::cut);
        EXPECT_TRUE(eventually([&] { return hardware.seen().size() == 2; }));
    }
    EXPECT_THAT(hardware.seen(), ElementsAre("on", "cut", "on"));
}

TEST(PowerSwitch, NeverKeepsTheLoopWaiting) {
    Hardware hardware;
    const auto power = switch_on(hardware);
    ASSERT_TRUE(power);
    hardware.slow = true;
    const auto begin = std::chrono::steady_clock::now();
    (*power)->want(PowerState::cut);
    (*power)->want(PowerState::on);
    (*power)->want(PowerState::cut);
    static_cast<void>((*power)->take_news());
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(100));
    EXPECT_THAT(hardware.seen(), ElementsAre("on"));
    for (int i = 1; i <= 3; ++i) {
        hardware.go.release();
        EXPECT_TRUE(eventually([&] { return hardware.seen().size() == 1U + static_cast<std::size_t>(i); }));
    }
    EXPECT_THAT(hardware.seen(), ElementsAre("on", "cut", "on", "cut")) << "in the order of asking";
    hardware.go.release();
    (*power)->finish();
    EXPECT_THAT(hardware.seen(), ElementsAre("on", "cut", "on", "cut", "on"));
}

TEST(PowerSwitch, TriesAgainWithAFreshActuator) {
    Hardware hardware;
    const auto power = switch_on(hardware);
    ASSERT_TRUE(power);
    hardware.failing_cuts = 1;
    hardware.failing_opens = 1;
    (*power)->want(PowerState::cut);
    EXPECT_TRUE(eventually([&] { return (*power)->counts().cuts == 1; }));
    EXPECT_EQ(hardware.opened, 3);
    EXPECT_THAT((*power)->take_news(), IsEmpty());
    EXPECT_GT((*power)->counts().slowest_ms, 100) << "further tries count";
}

TEST(PowerSwitch, AFailureIsToldAndCountedAndTheEndRestores) {
    Hardware hardware;
    const auto power = switch_on(hardware);
    ASSERT_TRUE(power);
    hardware.failing_cuts = 100;
    (*power)->want(PowerState::cut);
    EXPECT_TRUE(eventually([&] { return (*power)->counts().failures == 1; }));
    EXPECT_THAT((*power)->take_news(), ElementsAre("the power was not cut: no answer in time"));
    EXPECT_THAT((*power)->take_news(), IsEmpty());
    hardware.failing_restores = 100;
    (*power)->finish();  // the state is not known: an order may have arrived whose answer did not
    EXPECT_THAT((*power)->take_news(), ElementsAre("the power was not restored: no answer in time"));
    EXPECT_EQ((*power)->counts().failures, 2U);
}

TEST(PowerSwitch, ACutThatDidNotLastIsAFailure) {
    Hardware hardware;
    const auto power = switch_on(hardware);
    ASSERT_TRUE(power);
    (*power)->want(PowerState::cut);
    EXPECT_TRUE(eventually([&] { return (*power)->counts().cuts == 1; }));
    hardware.comes_back = true;
    (*power)->want(PowerState::on);
    EXPECT_TRUE(eventually([&] { return (*power)->counts().restores == 1; }));
    EXPECT_THAT((*power)->take_news(), ElementsAre(HasSubstr("the power came back by itself: it was on again 0.")));
    EXPECT_EQ((*power)->counts().failures, 1U);
    (*power)->finish();
    EXPECT_THAT(hardware.seen(), ElementsAre("on", "cut", "on")) << "restored all the same";
    EXPECT_EQ((*power)->counts().failures, 1U) << "told once";
}

TEST(PowerSwitch, ACutThatIsNotWantedAnyMoreIsNotTriedAgain) {
    Hardware hardware;
    const auto power = switch_on(hardware);
    ASSERT_TRUE(power);
    hardware.failing_cuts = 1;
    hardware.slow = true;
    (*power)->want(PowerState::cut);
    (*power)->want(PowerState::on);
    hardware.go.release(2);  // the cut, once, and the restore
    EXPECT_TRUE(eventually([&] { return (*power)->counts().restores == 1; }));
    EXPECT_THAT(hardware.seen(), ElementsAre("on", "on"));
    EXPECT_EQ((*power)->counts().failures, 1U) << "the device under test has not felt it";
    hardware.failing_cuts = 1;
    (*power)->want(PowerState::cut);
    EXPECT_TRUE(eventually([&] { return hardware.begun == 4; }));
    std::thread end([&] { (*power)->finish(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    hardware.go.release(2);
    end.join();
    EXPECT_THAT(hardware.seen(), ElementsAre("on", "on", "on"));
}

TEST(PowerSwitch, LeavesOutPairsOfOrdersThatItCannotFollow) {
    Hardware hardware;
    const auto power = switch_on(hardware);
    ASSERT_TRUE(power);
    hardware.slow = true;
    constexpr int asked = 301;
    for (int i = 1; i <= asked; ++i)
        (*power)->want(i % 2 == 1 ? PowerState::cut : PowerState::on);
    for (int i = 0; i < asked + 1 && (*power)->counts().cuts < 33; ++i) {
        hardware.go.release();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    std::vector<std::string> news;
    EXPECT_TRUE(eventually([&] { return !(news = (*power)->take_news()).empty(); }));
    EXPECT_THAT(news.at(0), HasSubstr("orders were left out"));
    EXPECT_EQ(hardware.seen().back(), "cut") << "the last order stands";
    EXPECT_LE(hardware.seen().size(), 70U);
    hardware.go.release();
    hardware.slow = false;
    (*power)->finish();
    EXPECT_EQ(hardware.seen().back(), "on");
}

TEST(PowerSwitch, HasItsHardwareForItselfAlone) {
    Hardware hardware, other;
    hardware.name = "played relay 1 of process " + std::to_string(::getpid());
    other.name = "played relay 2 of process " + std::to_string(::getpid());
    auto first = switch_on(hardware);
    ASSERT_TRUE(first);
    EXPECT_TRUE(switch_on(other)) << "it is another one";
    const auto second = switch_on(hardware);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().message,
              hardware.name + " is switched by another run already, or by another receiver of this one");
    EXPECT_THAT(hardware.seen(), ElementsAre("on")) << "left alone";
    first->reset();
    EXPECT_TRUE(switch_on(hardware));
}

TEST(PowerSwitch, DoesNotStartWithoutItsHardware) {
    Hardware absent;
    absent.failing_opens = 1;
    EXPECT_EQ(switch_on(absent).error().message, "it is gone");
    Hardware refusing;
    refusing.failing_restores = 1;
    EXPECT_EQ(switch_on(refusing).error().message, "no answer in time");
}

}  // namespace
}  // namespace skyloop
