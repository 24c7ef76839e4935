// Actuators that need no USB: commands of the host, and the modem lines of a tty.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>

#include <cerrno>

#include "told_orders.hpp"
#include "wire/actuator/modem_line.hpp"

namespace skyloop {
namespace {

using testing::HasSubstr;

std::unique_ptr<Actuator> opened(const std::string& uri) {
    auto actuator = open_actuator(uri);
    EXPECT_TRUE(actuator) << actuator.error().message;
    return actuator ? std::move(*actuator) : nullptr;
}

TEST(CommandSwitch, RunsTheProgramsAndAsksTheThird) {
    const test::TemporaryFolder folder;
    const std::string file = (folder / "state").string();
    const auto actuator = opened("command:sh -c 'echo cut >\"$1\"' - '" + file + "'|sh -c 'echo on >\"$1\"' - '" +
                                 file + "'|cat '" + file + "'");
    ASSERT_TRUE(actuator);
    ASSERT_TRUE(actuator->cut());
    EXPECT_EQ(text_of(file), "cut\n");
    EXPECT_EQ(actuator->state().value(), PowerState::cut);
    ASSERT_TRUE(actuator->restore());
    EXPECT_EQ(text_of(file), "on\n");
    EXPECT_EQ(actuator->state().value(), PowerState::on);
}

TEST(CommandSwitch, NoShellSeesTheWords) {
    const auto actuator = opened("command:true|true|echo $HOME; `id` * >x");
    ASSERT_TRUE(actuator);
    EXPECT_EQ(actuator->state().error().message, "'echo' printed '$HOME; `id` * >x'; expected on or cut");
}

TEST(CommandSwitch, TellsWhatWentWrong) {
    const auto failing = opened("command:sh -c 'echo first >&2; echo no such plug >&2; exit 3'|/no/such/program");
    ASSERT_TRUE(failing);
    EXPECT_EQ(failing->cut().error().message, "'sh' ended with exit code 3: no such plug");
    EXPECT_THAT(failing->restore().error().message, HasSubstr("cannot start '/no/such/program'"));
    EXPECT_EQ(failing->state().value(), std::nullopt);
    const auto lying = opened("command:true|true|echo on");
    EXPECT_TRUE(lying->restore());
    EXPECT_EQ(lying->cut().error().message, "'true' did its work, and 'echo' says on all the same");
    EXPECT_EQ(opened("command:true|true|echo off")->state().error().message,
              "'echo' printed 'off'; expected on or cut");
}

TEST(CommandSwitch, ACutThatTakesTooLongGivesWayToTheWishToRestore) {
    const auto actuator = opened("command:sleep 8|true");
    ASSERT_TRUE(actuator);
    bool wanted = true;
    int asked = 0;
    actuator->ask_while_cutting([&] { return wanted = ++asked < 10; });
    EXPECT_EQ(actuator->cut().error().message, "'sleep' had not ended when the power was wanted back");
    EXPECT_FALSE(wanted);
    const auto quick = opened("command:sleep 0.2|sleep 0.2");
    ASSERT_TRUE(quick);
    quick->ask_while_cutting([] { return false; });
    EXPECT_TRUE(quick->cut()) << "a short cut has the time to begin";
    EXPECT_TRUE(quick->restore());
}

// A device with modem lines, which no pseudo-terminal has.
class PlayedLines : public SerialSystem {
public:
    int lines = TIOCM_RTS | TIOCM_DTR;  // as Linux leaves them at an open
    termios2 settings{};
    bool held = false, stuck = false;

    int open(const std::filesystem::path&) override { return SerialSystem::open("/dev/null"); }
    int lock(int) override { return held ? -1 : 0; }
    using SerialSystem::control;
    int control(int, unsigned long request, void* argument) override {
        int& bits = *static_cast<int*>(argument);
        if (request == TIOCMGET) return bits = lines, 0;
        if (request == TIOCMBIS) return stuck ? 0 : (lines |= bits, 0);
        if (request == TIOCMBIC) return stuck ? 0 : (lines &= ~bits, 0);
        if (request == TCGETS2) return *static_cast<termios2*>(argument) = settings, 0;
        if (request == TCSETS2) return settings = *static_cast<termios2*>(argument), 0;
        errno = ENOTTY;
        return -1;
    }
};

TEST(ModemLineSwitch, MovesItsLineAlone) {
    const auto system = std::make_shared<PlayedLines>();
    system->settings.c_cflag = HUPCL | CLOCAL;
    const auto rts = open_modem_line({"/dev/ttyUSB0", ModemLineAddress::Line::rts, ActiveLevel::cuts}, system);
    ASSERT_TRUE(rts) << rts.error().message;
    EXPECT_EQ(system->settings.c_cflag, static_cast<tcflag_t>(CLOCAL)) << "the level stays when the device is closed";
    ASSERT_TRUE((*rts)->restore());
    EXPECT_EQ(system->lines, TIOCM_DTR);
    EXPECT_EQ((*rts)->state().value(), PowerState::on);
    ASSERT_TRUE((*rts)->cut());
    EXPECT_EQ(system->lines, TIOCM_DTR | TIOCM_RTS);
    EXPECT_EQ((*rts)->state().value(), PowerState::cut);
    EXPECT_EQ((*rts)->description(), "RTS of /dev/ttyUSB0");
}

TEST(ModemLineSwitch, TakesRtsFromFlowControl) {
    const auto system = std::make_shared<PlayedLines>();
    system->settings.c_cflag = CRTSCTS | CREAD;
    {
        const auto rts = open_modem_line({"/dev/ttyUSB0", ModemLineAddress::Line::rts, ActiveLevel::cuts}, system);
        ASSERT_TRUE(rts) << rts.error().message;
        EXPECT_EQ(system->settings.c_cflag, static_cast<tcflag_t>(CREAD | CLOCAL)) << "lost carrier is nothing to it";
    }
    EXPECT_EQ(system->settings.c_cflag, static_cast<tcflag_t>(CREAD)) << "flow control would move the line";
    system->settings.c_cflag = CRTSCTS | CREAD;
    const auto dtr = open_modem_line({"/dev/ttyUSB0", ModemLineAddress::Line::dtr, ActiveLevel::cuts}, system);
    ASSERT_TRUE(dtr);
    EXPECT_EQ(system->settings.c_cflag, static_cast<tcflag_t>(CRTSCTS | CREAD | CLOCAL));
}

TEST(ModemLineSwitch, MayPowerWhileAsserted) {
    const auto system = std::make_shared<PlayedLines>();
    const auto dtr = open_modem_line({"/dev/ttyUSB0", ModemLineAddress::Line::dtr, ActiveLevel::powers}, system);
    ASSERT_TRUE(dtr);
    EXPECT_EQ((*dtr)->state().value(), PowerState::on);
    ASSERT_TRUE((*dtr)->cut());
    EXPECT_EQ(system->lines, TIOCM_RTS);
    ASSERT_TRUE((*dtr)->restore());
    EXPECT_EQ(system->lines, TIOCM_RTS | TIOCM_DTR);
}

TEST(ModemLineSwitch, TellsWhatIsHeldOrStuck) {
    const auto system = std::make_shared<PlayedLines>();
    const ModemLineAddress rts{"/dev/ttyUSB0", ModemLineAddress::Line::rts, ActiveLevel::cuts};
    system->held = true;
    EXPECT_THAT(open_modem_line(rts, system).error().message, HasSubstr("another program holds it (flock)"));
    system->held = false;
    system->stuck = true;
    const auto stuck = open_modem_line(rts, system);
    ASSERT_TRUE(stuck);
    EXPECT_EQ((*stuck)->restore().error().message,
              "RTS of /dev/ttyUSB0 did not follow: the driver says it is asserted");
}

}  // namespace
}  // namespace skyloop
