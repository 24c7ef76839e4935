/// One process of a pool.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop {

/// A program with a socket at its standard input and a pipe from its standard output, in a process group of its own, so
/// that a terminal's Ctrl-C reaches whoever leads it alone. State: the process.
class WorkerProcess {
public:
    static Result<WorkerProcess> start(const std::vector<std::string>& command);
    WorkerProcess(WorkerProcess&& other) noexcept;
    WorkerProcess& operator=(WorkerProcess&& other) noexcept;
    /// Kills it and waits for its end.
    ~WorkerProcess();

    /// False: it does not listen any more.
    [[nodiscard]] bool tell(std::string_view line) const;
    /// Reads what has come; false: it has ended.
    [[nodiscard]] bool listen();
    /// The next whole line, without its end.
    [[nodiscard]] std::optional<std::string> take_line();
    [[nodiscard]] int descriptor() const { return from_; }
    void ask_to_end() const;
    /// Kills it where it still lives. @return "signal 9", "exit code 1"
    std::string finish();
    /// Whether it has ended by itself; does not wait.
    [[nodiscard]] bool has_ended();

    std::optional<std::uint64_t> job{};  ///< that it is at
    std::chrono::steady_clock::time_point since{};
    bool overdue = false;  ///< it was asked to end, having been at it for too long

private:
    WorkerProcess() = default;
    void close_pipes();

    pid_t process_ = -1;
    int to_ = -1, from_ = -1;
    std::string heard_;
    int status_ = 0;
};

}  // namespace skyloop
