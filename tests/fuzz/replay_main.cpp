// fuzz_replay NAME FOLDER…: runs the fuzz body of that name over every file of the corpus folders.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "replay_body.hpp"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> corpus_files(const fs::path& folder) {
    std::vector<fs::path> files;
    if (fs::is_directory(folder))
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

std::map<std::string_view, ReplayBody>& replay_bodies() {
    static std::map<std::string_view, ReplayBody> bodies;
    return bodies;
}

int main(int argc, char** argv) {
    const char* const name = argc > 1 ? argv[1] : "";
    const auto body = replay_bodies().find(name);
    if (body == replay_bodies().end()) {
        std::fprintf(stderr, "fuzz_replay: found '%s'; expected the name of a fuzz body and folders\n", name);
        return 2;
    }
    std::size_t count = 0;
    for (int i = 2; i < argc; ++i) {
        for (const fs::path& path : corpus_files(argv[i])) {
            std::ifstream file(path, std::ios::binary);
            const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
            const std::vector<std::uint8_t> input(bytes.begin(), bytes.end());
            body->second(input.data(), input.size());
            ++count;
        }
    }
    std::printf("%zu inputs replayed\n", count);
    return count > 0 ? 0 : 1;
}
