/// Whole messages on the wires of one receiver, for whoever watches.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "firmware/core/command_line_reader.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "run/fault/run_observer.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline run {

/// What a message is called: "CFG-VALSET", "UBX-0F-01" for one that no document names, "GGA", "PUBX,41", "RTCM-1005",
/// "sso".
std::string message_name(StreamKind kind, ByteSpan message);

/// Finds messages in the bytes of both ends and shows them.
///
/// State: what is unfinished on each wire.
class Dialogue {
public:
    struct Listener {
        std::function<void(const MessageSeen&)> message;
        std::function<void(const BeliefSeen&)> belief;
    };
    /// @param station whose wires they are
    /// @param command_line the receiver takes lines of text as commands: a client's lines are messages
    Dialogue(std::size_t station, Listener listener, bool command_line = false)
        : station_(station), listener_(std::move(listener)), command_line_(command_line) {}

    /// Without an ear for messages it tells of clients' beliefs alone.
    void listen(bool to_messages) { listening_ = to_messages; }

    void client_said(std::size_t wire, ByteSpan bytes, GpsTime now);
    void receiver_said(std::size_t wire, ByteSpan bytes, GpsTime now);
    void client_believes(std::size_t wire, const ClientBelief& belief, GpsTime now);

private:
    struct Ends {
        PatientSplitter client;
        StreamSplitter receiver;
        firmware::CommandLineReader commands{};  // of the client
    };
    Ends& ends(std::size_t wire);
    void give_way(std::size_t wire, GpsTime now);
    void show(std::size_t wire, bool from_client, const std::vector<StreamPiece>& pieces, GpsTime now);
    void show_commands(std::size_t wire, ByteSpan bytes, GpsTime now);

    std::size_t station_;
    Listener listener_;
    bool command_line_;
    bool listening_ = true;
    std::vector<Ends> ends_;
};

}  // namespace skyloop::inline run
