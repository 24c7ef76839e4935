#include "campaigns/engines/engine_task.hpp"

#include <gmock/gmock.h>

#include "campaigns/engines/engine_scripts.hpp"
#include "engine_rig.hpp"

namespace skyloop {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::vector<TemplateValue> values{{"command", "run 'it'"}, {"lines", "- a\n- b\n"}, {"none", ""}, {"n", "4"}};

std::string filled(const std::string& text) {
    const auto done = fill_template({"site.sh", text}, values);
    return done ? *done : done.error().message;
}

TEST(EngineTemplate, PlaceholdersBecomeTheirValues) {
    EXPECT_EQ(filled("@command@\n"), "run 'it'\n");
    EXPECT_EQ(filled("a=@n@@n@ @command@ # @n@"), "a=44 run 'it' # 4\n");
    EXPECT_EQ(filled("\"$@\" @command@ USR1@45 @@n@ @ x@y @N@ a@\n"), "\"$@\" run 'it' USR1@45 @4 @ x@y @N@ a@\n");
}

TEST(EngineTemplate, APlaceholderAloneTakesAllLinesOrNone) {
    EXPECT_EQ(filled("args:\n  @lines@\n  @none@\nend @command@\n"), "args:\n  - a\n  - b\nend run 'it'\n");
    EXPECT_EQ(filled("@command@\nx @none@\n"), "run 'it'\nx \n");
    EXPECT_THAT(filled("@command@\n    @run_child@\n"),
                AllOf(HasSubstr("\n    \"$@\" &\n"), HasSubstr("\n    done\n")));
}

TEST(EngineTemplate, NamesThatAreNotKnownAreToldWithTheNearest) {
    EXPECT_EQ(filled("@command@\n\n  @comand@ x\n"),
              "site.sh:3: found @comand@; expected one of @command@ @lines@ @n@ @none@ @run_child@; did you mean "
              "'command'?");
    EXPECT_EQ(filled("echo @n@\n"), "site.sh: nowhere asks for @command@; expected it, for without it nothing is done");
}

class SiteTemplates : public test::EngineRig {
protected:
    std::string refusal_of(std::string_view engine, const std::string& name) {
        const auto added = add_engine_template(task.templates, engine, root / name);
        return added ? "" : added.error().message;
    }
};

TEST_F(SiteTemplates, TakeThePlaceOfThoseOfTheirName) {
    EXPECT_THAT(template_names("slurm"), ElementsAre("slurm.sbatch", "slurm_gather.sbatch"));
    write(root / "slurm.sbatch", "#!/bin/bash\n#SBATCH --array=0-@last_shard@\nmodule load gnss\n@command@ @shards@\n");
    ASSERT_EQ(refusal_of("slurm", "slurm.sbatch"), "");
    const auto scripts = slurm_scripts(task, {});
    ASSERT_TRUE(scripts) << scripts.error().message;
    EXPECT_THAT(scripts->shards, StartsWith("#!/bin/bash\n#SBATCH --array=0-3\nmodule load gnss\n/"));
    EXPECT_THAT(scripts->gather, HasSubstr("# Merges the results"));
    write(root / "parallel.sh", "sh @shard_call@ @retries@\n");
    ASSERT_EQ(refusal_of("parallel", "parallel.sh"), "");
    const auto wrong = parallel_scripts(task, {":\n", "[run]\n"});
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().code, ErrorCode::input);
    EXPECT_THAT(wrong.error().message,
                StartsWith((root / "parallel.sh").string() + ":1: found @retries@; expected one"));
}

TEST_F(SiteTemplates, OfAnotherNameAreRefused) {
    write(root / "slurm.sbtach", "x");
    EXPECT_EQ(refusal_of("slurm", "slurm.sbtach"),
              "--engine-template " + (root / "slurm.sbtach").string() +
                  ": found the name 'slurm.sbtach'; expected that of a template of --engine slurm: slurm.sbatch, "
                  "slurm_gather.sbatch; did you mean 'slurm.sbatch'?");
    EXPECT_THAT(refusal_of("slurm", "kubernetes.yaml"), HasSubstr("expected that of a template of --engine slurm"));
    EXPECT_THAT(refusal_of("parallel", "parallel.sh"), HasSubstr("No such file"));
}

}  // namespace
}  // namespace skyloop
