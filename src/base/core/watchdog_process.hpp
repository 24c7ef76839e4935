/// A process beside the program that sees to what is left when the program is killed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "base/core/file_descriptor.hpp"
#include "base/core/process.hpp"
#include "base/core/result.hpp"

namespace skyloop::inline base {

/// The program's end of a socket to a process that outlives it, and takes no signal which ends programs in order.
/// State: both.
class WatchdogProcess {
public:
    /// Forks: to be called before the program has any other thread. `work` is called in the new process, in a session
    /// of its own, with its end of the socket (SOCK_SEQPACKET), which ends with the program; afterwards the process
    /// ends.
    /// @param name of the process, 15 characters at most
    /// Fails with `outside` when the system has no process to spare.
    static Result<std::unique_ptr<WatchdogProcess>> start(const char* name, const std::function<void(int)>& work);
    /// Closes the socket and waits for the end of the process.
    ~WatchdogProcess();
    WatchdogProcess(const WatchdogProcess&) = delete;
    WatchdogProcess& operator=(const WatchdogProcess&) = delete;

    /// False when it is gone.
    bool tell(const void* record, std::size_t size) const;

private:
    WatchdogProcess(int child, FileDescriptor socket) : child_(child), socket_(std::move(socket)) {}
    int child_;
    FileDescriptor socket_;
};

/// The next record of a socket of WatchdogProcess; false when the program is gone.
bool hear_record(int socket, void* record, std::size_t size);
/// Kills what is left of a process group, and waits until nothing is, for a second at most.
void end_process_group(int group);

/// Ends the programs that its own program leaves behind when it is killed with SIGKILL or crashes; a program that has
/// been started in that very moment, so that its listener has not heard of it yet, stays.
class OrphanWatchdog {
public:
    /// As WatchdogProcess::start().
    static Result<std::unique_ptr<OrphanWatchdog>> start();
    /// For ProcessRequest::group of one program after the other; each that runs beside others has its own. Not beyond
    /// the life of this object. Thread-safe.
    [[nodiscard]] ProcessGroupListener listener();

private:
    explicit OrphanWatchdog(std::unique_ptr<WatchdogProcess> process) : process_(std::move(process)) {}
    std::unique_ptr<WatchdogProcess> process_;
    std::atomic<std::int32_t> listeners_ = 0;
};

}  // namespace skyloop::inline base
