/// Runs a program of the host, bounded in time and output.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"

namespace skyloop::inline base {

/// Hears the number of a process group when it has begun; nothing once it has been killed, before the number can become
/// another's.
using ProcessGroupListener = std::function<void(std::optional<int> group)>;

/// What is run, and how far it may go.
struct ProcessRequest {
    std::vector<std::string> command;        ///< a program, sought in PATH, and its arguments; at least the program
    std::vector<std::string> environment{};  ///< "NAME=VALUE", beside the caller's own; the last of a name counts
    Seconds timeout{10};                     ///< by the host's clock
    std::size_t output_limit = 1 << 20;      ///< bytes that are kept of each output; what follows is read and dropped
    /// Called with each whole line of the standard output, without its end, at most 65 536 bytes of it; true: that was
    /// enough, the process is killed.
    std::function<bool(std::string_view)> line{};
    std::function<bool()> cancelled{};  ///< asked some fifty times a second; true: the process is killed
    ProcessGroupListener group{};
};

/// How it ended.
struct ProcessOutcome {
    std::optional<int> exit_code{};  ///< nothing: it was killed
    std::optional<int> signal{};     ///< that ended it
    bool timed_out = false, cancelled = false, enough = false;
    bool output_cut = false;  ///< more was printed than was kept
    std::string output, errors;
};

/// Runs the program in a process group of its own with an empty standard input, and waits for its end; whatever is left
/// of the group is killed then. Blocks the calling thread, at most a tenth of a second longer than the timeout. Fails
/// with `outside` when the program cannot be started.
Result<ProcessOutcome> run_process(const ProcessRequest& request);

}  // namespace skyloop::inline base
