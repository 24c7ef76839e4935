#include "campaigns/engines/engine_task.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <limits>

#include "campaigns/engines/engine_files.hpp"
#include "engine_rig.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;
using EngineFolder = test::EngineRig;

TEST(DefaultShards, HaveTenRunsEachUpToAThousandShards) {
    EXPECT_EQ(default_shards(0), 1u);
    EXPECT_EQ(default_shards(10), 1u);
    EXPECT_EQ(default_shards(11), 2u);
    EXPECT_EQ(default_shards(2'000), 200u);
    EXPECT_EQ(default_shards(std::numeric_limits<std::size_t>::max()), 1000u);
}

TEST(PlainName, IsALabelForEveryEngine) {
    EXPECT_EQ(plain_name("Night of 100% tests!"), "night-of-100-tests");
    EXPECT_EQ(plain_name("--"), "campaign");
    EXPECT_EQ(plain_name("ü"), "campaign");
    EXPECT_EQ(plain_name(std::string(90, 'x')).size(), 40u);
    EXPECT_EQ(plain_name(std::string(39, 'x') + " y"), std::string(39, 'x'));
}

TEST_F(EngineFolder, WithOddNamesIsTaken) { EXPECT_TRUE(check_task(task)); }

TEST_F(EngineFolder, NoShardOrTooManyIsRefused) {
    for (const std::size_t shards : {std::size_t{0}, max_shards + 1, std::numeric_limits<std::size_t>::max()}) {
        task.shards = shards;
        const auto answer = check_task(task);
        ASSERT_FALSE(answer);
        EXPECT_THAT(answer.error().message, HasSubstr("expected 1 to 100000"));
    }
}

TEST_F(EngineFolder, LinesInNamesAreRefused) {
    task.out = root / "a\n#SBATCH --uid=0";
    EXPECT_FALSE(check_task(task));
    task.out = "relative";
    EXPECT_FALSE(check_task(task));
    task.out = root;
    task.options = {"--vary", "a\nb"};
    EXPECT_FALSE(check_task(task));
}

TEST_F(EngineFolder, ResultsAreCountedAsTheyCome) {
    ResultCounter counter(root);
    EXPECT_EQ(counter.look(), 0u);
    write(root / "shards/0-of-2.csv", "key\na\nb\ntorn");
    write(root / "shards/0-of-2.log.csv", "host\nx\nx\nx\n");
    write(root / "shards/1-of-2.csv", "");
    EXPECT_EQ(counter.look(), 2u);
    std::ofstream(root / "shards/0-of-2.csv", std::ios::app) << "\nc\n";
    write(root / "shards/1-of-2.csv", "key\nd\n");
    EXPECT_EQ(counter.look(), 5u);
    write(root / "shards/0-of-2.csv", "key\na\n");
    EXPECT_EQ(counter.look(), 2u);
}

TEST_F(EngineFolder, ANumberIsReadWholeOrNotAtAll) {
    for (const auto& [text, number] : {std::pair<const char*, std::optional<int>>{"75\n", 75},
                                       {"0", 0},
                                       {"", std::nullopt},
                                       {"7x\n", std::nullopt},
                                       {"3\n\n", std::nullopt},
                                       {"99999999999999999999\n", std::nullopt}}) {
        write(root / "n", text);
        EXPECT_EQ(whole_number_of(root / "n"), number) << text;
    }
    EXPECT_EQ(whole_number_of(root / "none"), std::nullopt);
}

}  // namespace
}  // namespace skyloop
