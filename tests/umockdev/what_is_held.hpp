/// What a process holds: it must not grow with what comes and goes.
#pragma once

#include <malloc.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace skyloop::mock {

/// Numbers of the sockets by which umockdev answers for nodes: it closes them when it likes, some never.
inline std::set<std::string> sockets_of_umockdev() {
    std::set<std::string> numbers;
    std::ifstream table("/proc/net/unix");
    for (std::string line; std::getline(table, line);) {
        std::istringstream columns(line);
        const std::vector<std::string> words{std::istream_iterator<std::string>(columns), {}};
        if (words.size() > 7 && words[7].find("/ioctl/") != std::string::npos) numbers.insert(words[6]);
    }
    return numbers;
}

/// Of this process, without those of umockdev itself.
inline std::size_t open_descriptors() {
    const std::set<std::string> sockets = sockets_of_umockdev();
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
        std::error_code gone;
        const std::string target = std::filesystem::read_symlink(entry.path(), gone);
        const bool socket = target.starts_with("socket:[");
        if (!socket || !sockets.contains(target.substr(8, target.size() - 9))) ++count;
    }
    return count;
}

/// umockdev's own thread closes what it needed for a device a little later than the device is gone.
inline bool comes_down_to(std::size_t most, const std::function<std::size_t()>& count) {
    for (int i = 0; i < 100; ++i) {
        if (count() <= most) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
}

/// Bytes in use; what freed memory waits in caches is none of it.
inline std::size_t memory_in_use() { return mallinfo2().uordblks; }

}  // namespace skyloop::mock
