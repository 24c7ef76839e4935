/// A pseudo-terminal: to a client a serial port like any other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/core/file_descriptor.hpp"
#include "base/core/result.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline wire {

/// The master side of a pseudo-terminal whose other side clients open (facts: WIRES.md section 1).
///
/// Nothing is written while no client has it open, and a client never reads what an earlier one left unread. A client
/// that does not read fills the kernel's 16 to 20 kB; write() then takes fewer bytes.
class PtyTransport : public Transport {
public:
    /// A terminal in raw mode, 8N1, that every user may open.
    /// @param link where to publish it: a symbolic link, made in one step, that replaces another one to a
    ///        pseudo-terminal but no other file, nor a link that a terminal of a living program is published under. Its
    ///        folder must exist.
    ///        Removed at the end if it still leads here.
    /// Fails with `outside` when the link is another's, or the system refuses.
    static Result<std::unique_ptr<PtyTransport>> open(const std::optional<std::filesystem::path>& link = std::nullopt);
    ~PtyTransport() override;
    PtyTransport(const PtyTransport&) = delete;
    PtyTransport& operator=(const PtyTransport&) = delete;

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    LineState line() override;
    /// Sets the terminal's speed the first time it is called; from then on the speed is the clients' affair.
    void set_receiver_baud(std::uint32_t baud) override;
    [[nodiscard]] std::string description() const override;

    /// "/dev/pts/N".
    [[nodiscard]] const std::string& terminal() const { return terminal_; }
    /// How many times clients have it open.
    int clients();

private:
    PtyTransport(FileDescriptor master, std::string terminal)
        : master_(std::move(master)), terminal_(std::move(terminal)) {}

    Result<void> prepare();
    Result<void> publish(const std::filesystem::path& link);
    void watch();
    void follow_clients();
    bool read_events();
    void forget_unread();

    FileDescriptor master_;
    FileDescriptor events_;  ///< inotify: opens and closes of the terminal
    int watch_ = -1;
    std::string terminal_;
    std::filesystem::path link_;  ///< absolute; empty when not published
    FileDescriptor claim_;        ///< that the link is ours, while this is open
    int clients_ = 0;
    bool counted_early_ = false;
    bool unread_possible_ = false;  ///< bytes were written that a client may have left
    bool speed_set_ = false;
    bool looked_ = false;    ///< line() has just looked, also for the read() or write() that follows
    bool readable_ = false;  ///< bytes were there then
};

}  // namespace skyloop::inline wire
