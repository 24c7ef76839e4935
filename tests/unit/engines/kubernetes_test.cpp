// The manifests' values; a parser of YAML and a schema look at them in tests/cluster.
#include "campaigns/engines/engine_scripts.hpp"

#include <gmock/gmock.h>

#include "engine_rig.hpp"

namespace skyloop {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class KubernetesEngine : public test::EngineRig {
protected:
    KubernetesEngine() {
        settings.image = "registry.example/skyloop:1.0";
        settings.claim = "lab.results-1";
        settings.mount = root;
    }
    std::string refusal() {
        const auto manifests = kubernetes_manifests(task, settings);
        return manifests ? "" : manifests.error().message;
    }
    KubernetesSettings settings;
};

TEST_F(KubernetesEngine, AnIndexIsAShardAndItsExitCodeIsUnderstood) {
    const auto manifests = kubernetes_manifests(task, settings);
    ASSERT_TRUE(manifests) << manifests.error().message;
    EXPECT_THAT(
        manifests->shards,
        AllOf(HasSubstr("  name: \"skyloop-night-of-it-s-100-hard-tests\"\n"), HasSubstr("  completionMode: Indexed\n"),
              HasSubstr("  completions: 4\n  parallelism: 4\n  backoffLimitPerIndex: 3\n"),
              HasSubstr("  podReplacementPolicy: Failed\n"), HasSubstr("--shard \"$JOB_COMPLETION_INDEX/4\""),
              HasSubstr("          values: [2]\n")));
    EXPECT_THAT(manifests->shards, HasSubstr("- \"" + root.string() + "/out of 100% \\\"it's\\\" $$HOME #1\"\n"));
    EXPECT_THAT(manifests->gather,
                AllOf(HasSubstr("- \"gather\"\n"), HasSubstr("job/skyloop-night-of-it-s-100-hard-tests\n")));
}

TEST_F(KubernetesEngine, ContainersRunAsWhoeverOwnsTheResults) {
    auto manifests = kubernetes_manifests(task, settings);
    ASSERT_TRUE(manifests) << manifests.error().message;
    for (const std::string& text : {manifests->shards, manifests->gather})
        EXPECT_THAT(text, Not(HasSubstr("runAs"))) << "the superuser's is the image's own affair";
    settings.user = 1000;
    settings.group = 100;
    manifests = kubernetes_manifests(task, settings);
    ASSERT_TRUE(manifests) << manifests.error().message;
    for (const std::string& text : {manifests->shards, manifests->gather})
        EXPECT_THAT(text, HasSubstr("      terminationGracePeriodSeconds: 45\n"
                                    "      securityContext:\n"
                                    "        runAsUser: 1000\n"
                                    "        runAsGroup: 100\n"
                                    "        fsGroup: 100\n"
                                    "        fsGroupChangePolicy: OnRootMismatch\n"
                                    "      containers:\n"));
}

TEST_F(KubernetesEngine, PathsOutsideTheMountAreRefused) {
    settings.mount = root / "elsewhere";
    EXPECT_THAT(refusal(), AllOf(HasSubstr("scenario '"), HasSubstr("expected a path under --mount")));
    settings.mount = root;
    task.out = root / ".." / "results";
    EXPECT_THAT(refusal(), HasSubstr("--out '"));
    settings.mount = "data";
    EXPECT_THAT(refusal(), HasSubstr("--mount 'data': expected an absolute path"));
}

TEST_F(KubernetesEngine, NamesThatKubernetesDoesNotTakeAreRefused) {
    for (const char* image : {"", "a b", "a\nb"}) {
        settings.image = image;
        EXPECT_THAT(refusal(), HasSubstr("--image")) << image;
    }
    settings.image = "skyloop";
    for (const char* claim : {"", "Claim", "-a", "a-", "a_b"}) {
        settings.claim = claim;
        EXPECT_THAT(refusal(), HasSubstr("--claim")) << claim;
    }
    settings.claim = "a";
    settings.name_space = "lab.one";
    EXPECT_THAT(refusal(), HasSubstr("--namespace"));
    settings.name_space.clear();
    for (const char* memory : {"", "512MB", "Gi", "1.5.2Gi", ".5Gi", "1 Gi", "1gi"}) {
        settings.memory = memory;
        EXPECT_THAT(refusal(), HasSubstr("--memory")) << memory;
    }
    for (const char* memory : {"1Gi", "1.5G", "200000000", "512Mi"}) {
        settings.memory = memory;
        EXPECT_EQ(refusal(), "") << memory;
    }
    const auto mount = settings.mount;
    settings.mount = "/";
    EXPECT_THAT(refusal(), HasSubstr("--mount '/'"));
    settings.mount = mount;
    settings.parallelism = 0;
    EXPECT_THAT(refusal(), HasSubstr("--parallelism"));
}

TEST_F(KubernetesEngine, TextsThatAreNotUtf8AreRefused) {
    for (const char* text : {"\xff", "\xc3", "\xc3(", "\xe2\x82", "\x80"}) {
        task.options = {text};
        EXPECT_THAT(refusal(), HasSubstr("is not UTF-8")) << text;
    }
    task.options = {"\xc3\xbc \xe2\x82\xac \xf0\x9f\x9b\xb0"};
    EXPECT_EQ(refusal(), "");
}

}  // namespace
}  // namespace skyloop
