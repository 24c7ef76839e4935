/// A folder with a campaign's files in it, a Slurm that is not there, and a program that stands for skyloop.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "campaigns/engines/engine_task.hpp"

namespace skyloop::test {

/// Each test has a folder whose name no shell takes as it is.
class EngineRig : public ::testing::Test {
protected:
    EngineRig() {
        std::string pattern = (std::filesystem::temp_directory_path() / "skyloop-engines-XXXXXX").string();
        const char* const made = ::mkdtemp(pattern.data());
        root = made == nullptr ? "" : made;
        const auto tools = std::filesystem::path(SKYLOOP_SOURCE_DIR) / "tests/unit/engines/fake_slurm";
        const char* const path = ::getenv("PATH");
        ::setenv("PATH", (tools.string() + ":" + (path == nullptr ? "/usr/bin:/bin" : path)).c_str(), 1);
        ::setenv("FAKE_SLURM", root.c_str(), 1);
        task.name = "Night of it's 100% \"hard\" tests";
        task.program = tools / "skyloop";
        task.scenario = root / "a b's.toml";
        task.out = root / "out of 100% \"it's\" $HOME #1";
        task.options = {"--vary", "world.name=\"a b\",'c'"};
        task.shards = 4;
    }
    ~EngineRig() override {
        std::error_code ignored;
        if (!root.empty()) std::filesystem::remove_all(root, ignored);
    }

    static std::string text_of(const std::filesystem::path& file) {
        std::ifstream input(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(input), {}};
    }
    static void write(const std::filesystem::path& file, const std::string& text) {
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
    }
    static std::size_t lines_of(const std::filesystem::path& file) {
        const std::string text = text_of(file);
        return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }

    std::filesystem::path root;
    EngineTask task;
};

}  // namespace skyloop::test
