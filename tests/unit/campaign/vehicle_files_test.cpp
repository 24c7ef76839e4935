#include "campaigns/campaign/detail/vehicle_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "unit/transport/temporary_folder.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(VehicleFiles, AreTheProgramsThatWordsOfACommandName) {
    const test::TemporaryFolder folder;
    for (const char* name : {"sitl", "my sim.py", "log"})
        std::ofstream(folder / name) << "x";
    std::ofstream(folder / "script") << "#!/bin/sh\n";
    std::filesystem::permissions(folder / "sitl", std::filesystem::perms::owner_all);
    const std::string at = folder.path().string() + "/";
    EXPECT_THAT(programs_of_command(at + "sitl {pty}"), ElementsAre(at + "sitl"));
    EXPECT_THAT(programs_of_command("cd /;python3 '" + at + "my sim.py' --seed={seed}&&" + at + "sitl"),
                ElementsAre(at + "my sim.py", at + "sitl"));
    EXPECT_THAT(programs_of_command(at + "my\\ sim.py<\"" + at + "script\""),
                ElementsAre(at + "my sim.py", at + "script"));
    EXPECT_THAT(programs_of_command(at + "sitl --log " + at + "log"), ElementsAre(at + "sitl"));
    EXPECT_THAT(programs_of_command(at + "sitl >" + at + "log 2>> " + at + "log"), ElementsAre(at + "sitl"))
        << "what it writes is none of it";
    EXPECT_THAT(programs_of_command("sitl " + at + "absent " + folder.path().string() + " /dev/null"), IsEmpty());
}

}  // namespace
}  // namespace skyloop
