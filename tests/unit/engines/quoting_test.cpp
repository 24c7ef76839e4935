// Words that another language reads back as they were; a real shell is asked.
#include "campaigns/engines/engine_task.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "base/core/process.hpp"

namespace skyloop {
namespace {

using ::testing::ElementsAreArray;

// What the words of a command are to a shell, each followed by a line of its own that no word here holds.
std::vector<std::string> read_by_sh(const std::string& command) {
    ProcessRequest request;
    request.command = {"sh", "-c", "for word in " + command + "; do printf '%s\\001' \"$word\"; done"};
    const auto outcome = run_process(request);
    EXPECT_TRUE(outcome && outcome->exit_code == 0) << command;
    std::vector<std::string> words;
    std::string word;
    for (const char c : outcome ? outcome->output : std::string()) {
        if (c == '\1')
            words.push_back(std::exchange(word, {}));
        else
            word += c;
    }
    return words;
}

TEST(ShellQuoted, LeavesPlainWordsAsTheyAre) {
    EXPECT_EQ(shell_quoted("--seeds=1..100"), "--seeds=1..100");
    EXPECT_EQ(shell_quoted("a b"), "'a b'");
    EXPECT_EQ(shell_quoted(""), "''");
    EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
}

TEST(ShellQuoted, IsReadBackByAShell) {
    std::vector<std::string> words{"",  " ",  "~",  "$HOME", "`id`",      "a'b\"c\\d",
                                   "*", "#x", "!x", "-n",    "a;b&c|d>e", "ü\t{}"};
    std::mt19937 random(7);
    std::uniform_int_distribution<int> byte(2, 255), length(0, 12);
    for (int i = 0; i < 200; ++i) {
        std::string word;
        for (int k = length(random); k > 0; --k)
            word += static_cast<char>(byte(random));
        words.push_back(word);
    }
    EXPECT_THAT(read_by_sh(shell_quoted(words)), ElementsAreArray(words));
}

TEST(SbatchQuoted, PutsABackslashBeforeWhatWouldEndTheWord) {
    EXPECT_EQ(sbatch_quoted("--output=a b"), "\"--output=a b\"");
    EXPECT_EQ(sbatch_quoted("a\"b\\c"), "\"a\\\"b\\\\c\"");
    EXPECT_EQ(sbatch_pattern("/x/50%done/%a"), "/x/50%%done/%%a");
}

TEST(YamlQuoted, EscapesWhatAQuotedScalarMayNotHold) {
    EXPECT_EQ(yaml_quoted("no"), "\"no\"");
    EXPECT_EQ(yaml_quoted("a\"b\\c\n"), "\"a\\\"b\\\\c\\x0a\"");
}

TEST(KubernetesLiteral, DoublesWhatBeginsAReplacement) {
    EXPECT_EQ(kubernetes_literal("$(HOME)/a$b"), "$$(HOME)/a$$b");
}

}  // namespace
}  // namespace skyloop
