#include <sys/socket.h>

#include <algorithm>
#include <utility>

#include "base/core/threads.hpp"
#include "detail/feed_link.hpp"
#include "wire/transport/serial.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::size_t most_stream_clients = 8;
constexpr std::size_t stream_piece = 65536;         // at one look, of each
constexpr std::size_t most_stream_answers = 65536;  // that wait for a client that does not read

// A server for several sources.
class StreamListenLink : public FeedLink {
public:
    StreamListenLink(FileDescriptor socket, FeedHearer& hearer) : listener_(std::move(socket)), hearer_(hearer) {}

    void add_waits(std::vector<pollfd>& waits) const override {
        if (steady_clock_ns() >= rest_until_ns_) waits.push_back({listener_.value(), POLLIN, 0});
        for (const Client& client : clients_)
            waits.push_back(client.stream.wait(true));
    }

    bool serve(std::int64_t now_ns) override {
        accept_all(now_ns);
        bool any = false;
        for (Client& client : clients_) {
            client.stream.send_waiting();
            const Bytes& bytes = client.stream.read(stream_piece);
            if (bytes.empty()) continue;
            any = true;
            send(client, hearer_.hear(client.speaker, bytes, steady_clock_ns()).answers);
        }
        std::erase_if(clients_, [&](const Client& client) {
            const bool over = client.stream.gone() || client.stream.finished();
            if (!over) return false;
            hearer_.forget(client.speaker);
            hearer_.tell(FeedNewsDesk::Kind::connection, client.name + " has disconnected");
            return true;
        });
        return any;
    }

    void speak(std::int64_t) override {
        for (Client& client : clients_)
            send(client, hearer_.say(client.speaker));
    }

    void answer(std::uint64_t speaker, const std::vector<Bytes>& answers) override {
        for (Client& client : clients_)
            if (client.speaker == speaker) send(client, answers);
    }

    [[nodiscard]] std::uint16_t port() const override { return own_port(listener_.value()); }

private:
    struct Client {
        FeedStream stream;
        std::uint64_t speaker = 0;
        std::string name;
    };

    void accept_all(std::int64_t now_ns) {
        constexpr int most_at_once = 16;
        for (int i = 0; i < most_at_once; ++i) {
            FeedPeer peer;
            peer.length = sizeof peer.storage;
            FileDescriptor socket(::accept4(listener_.value(), reinterpret_cast<sockaddr*>(&peer.storage), &peer.length,
                                            SOCK_NONBLOCK | SOCK_CLOEXEC));
            if (!socket.open()) {
                constexpr std::int64_t rest_ns = 200'000'000;  // out of descriptors: trying again at once is no use
                if (errno != EAGAIN && errno != EWOULDBLOCK) rest_until_ns_ = now_ns + rest_ns;
                return;
            }
            const std::string name = shown_peer(peer);
            if (clients_.size() >= most_stream_clients) {
                hearer_.tell(FeedNewsDesk::Kind::connection, name + " was turned away: 8 are connected");
                continue;
            }
            clients_.push_back({FeedStream(std::move(socket)), ++speakers_, name});
            hearer_.tell(FeedNewsDesk::Kind::connection, name + " has connected");
            send(clients_.back(), hearer_.say(speakers_));
        }
    }

    void send(Client& client, const std::vector<Bytes>& answers) {
        for (const Bytes& answer : answers)
            if (client.stream.waiting() + answer.size() <= most_stream_answers) client.stream.send(answer);
    }

    FileDescriptor listener_;
    FeedHearer& hearer_;
    std::vector<Client> clients_;
    std::uint64_t speakers_ = 0;
    std::int64_t rest_until_ns_ = 0;
};

// A client that connects until it succeeds, and again when the connection is lost.
class StreamConnectLink : public FeedLink {
public:
    StreamConnectLink(std::vector<FeedPeer> peers, FeedHearer& hearer)
        : connector_(std::move(peers)), hearer_(hearer) {}

    void add_waits(std::vector<pollfd>& waits) const override {
        if (stream_.open())
            waits.push_back(stream_.wait(true));
        else if (connector_.descriptor() >= 0)
            waits.push_back({connector_.descriptor(), POLLOUT, 0});
    }

    bool serve(std::int64_t now_ns) override {
        if (!stream_.open()) connect(now_ns);
        if (!stream_.open()) return false;
        stream_.send_waiting();
        const Bytes& bytes = stream_.read(stream_piece);
        if (!bytes.empty()) {
            heard_ = true;
            answer(0, hearer_.hear(0, bytes, steady_clock_ns()).answers);
            return true;
        }
        if (!stream_.gone() && !stream_.finished()) return false;
        stream_.close();
        connector_.lost(now_ns, heard_);
        hearer_.reconnected(0);
        hearer_.tell(FeedNewsDesk::Kind::connection, "connection lost; trying again");
        return false;
    }

    void speak(std::int64_t) override {
        if (stream_.open()) answer(0, hearer_.say(0));
    }

    void answer(std::uint64_t, const std::vector<Bytes>& answers) override {
        for (const Bytes& answer : answers)
            if (stream_.open() && stream_.waiting() + answer.size() <= most_stream_answers) stream_.send(answer);
    }

private:
    void connect(std::int64_t now_ns) {
        std::string why;
        FileDescriptor socket = connector_.look(now_ns, why);
        if (!why.empty() && why != told_) {
            hearer_.tell(FeedNewsDesk::Kind::connection, "not connected: " + why + "; trying again");
            told_ = why;
        }
        if (!socket.open()) return;
        stream_ = FeedStream(std::move(socket));
        heard_ = false;
        told_.clear();
        hearer_.tell(FeedNewsDesk::Kind::connection, "connected");
        answer(0, hearer_.say(0));
    }

    StreamConnector connector_;
    FeedHearer& hearer_;
    FeedStream stream_;
    bool heard_ = false;
    std::string told_;  // why it does not come about
};

class SerialLink : public FeedLink {
public:
    SerialLink(std::unique_ptr<SerialTransport> line, FeedHearer& hearer) : line_(std::move(line)), hearer_(hearer) {}

    void add_waits(std::vector<pollfd>&) const override {}

    bool serve(std::int64_t) override {
        const Bytes bytes = line_->read();
        for (std::string& news : line_->take_news())
            hearer_.tell(FeedNewsDesk::Kind::connection, std::move(news));
        if (bytes.empty()) return false;
        answer(0, hearer_.hear(0, bytes, steady_clock_ns()).answers);
        return true;
    }

    void speak(std::int64_t) override { answer(0, hearer_.say(0)); }

    void answer(std::uint64_t, const std::vector<Bytes>& answers) override {
        for (const Bytes& bytes : answers)
            line_->write(bytes);
    }

    // The line has no descriptor to wait for, since it comes and goes with its adapter.
    [[nodiscard]] int longest_wait_ms() const override { return 4; }

private:
    std::unique_ptr<SerialTransport> line_;
    FeedHearer& hearer_;
};

// Stands between a program that connects to us and one that we connect to: all bytes go on at once, unmodified, and one
// direction is also heard. A slow reader holds the other end back, as without us.
class StreamRelay : public FeedLink {
public:
    StreamRelay(FileDescriptor listener, std::vector<FeedPeer> peers, bool hears_far, FeedHearer& hearer)
        : listener_(std::move(listener)), connector_(std::move(peers)), hears_far_(hears_far), hearer_(hearer) {}

    void add_waits(std::vector<pollfd>& waits) const override {
        if (!near_.open()) {
            waits.push_back({listener_.value(), POLLIN, 0});
            return;
        }
        if (!far_.open()) {
            if (connector_.descriptor() >= 0) waits.push_back({connector_.descriptor(), POLLOUT, 0});
            return;
        }
        waits.push_back(near_.wait(far_.waiting() < most_stream_answers));
        waits.push_back(far_.wait(near_.waiting() < most_stream_answers));
    }

    bool serve(std::int64_t now_ns) override {
        if (!near_.open()) accept();
        if (near_.open() && !far_.open() && near_.hung_up()) near_.close();
        if (near_.open() && !far_.open()) connect(now_ns);
        if (!near_.open() || !far_.open()) return false;
        near_.send_waiting();
        far_.send_waiting();
        const bool any_near = pass_on(near_, far_, !hears_far_), any_far = pass_on(far_, near_, hears_far_);
        const bool broken = near_.gone() || far_.gone();
        const bool over = (near_.finished() || far_.finished()) && !any_near && !any_far;
        if (!broken && !over) return any_near || any_far;
        near_.close();
        far_.close();
        connector_.lost(now_ns, true);
        hearer_.reconnected(0);
        hearer_.tell(FeedNewsDesk::Kind::connection, "one end has disconnected; both are let go");
        return false;
    }

    // What a relay would say of itself would not be theirs.
    void speak(std::int64_t) override {}
    void answer(std::uint64_t, const std::vector<Bytes>&) override {}
    [[nodiscard]] std::uint16_t port() const override { return own_port(listener_.value()); }
    [[nodiscard]] bool in_haste() const override { return true; }

private:
    bool pass_on(FeedStream& from, FeedStream& to, bool heard) {
        if (to.waiting() >= most_stream_answers) return true;
        const Bytes& bytes = from.read(stream_piece);
        if (bytes.empty()) return false;
        const std::int64_t received_ns = steady_clock_ns();
        to.send(bytes);
        if (heard) hearer_.hear(0, bytes, received_ns);
        return true;
    }

    void accept() {
        FileDescriptor socket(::accept4(listener_.value(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (socket.open()) near_ = FeedStream(std::move(socket));
    }

    void connect(std::int64_t now_ns) {
        std::string why;
        FileDescriptor socket = connector_.look(now_ns, why);
        if (!why.empty())
            hearer_.tell(FeedNewsDesk::Kind::connection, "the other end cannot be reached: " + why + "; trying again");
        if (!socket.open()) return;
        far_ = FeedStream(std::move(socket));
        hearer_.tell(FeedNewsDesk::Kind::connection, "both ends are connected");
    }

    FileDescriptor listener_;
    StreamConnector connector_;
    bool hears_far_;
    FeedHearer& hearer_;
    FeedStream near_, far_;
};

}  // namespace

Result<std::unique_ptr<FeedLink>> open_stream_link(const FeedAddress& address, FeedHearer& hearer) {
    if (address.wire == FeedWire::tcp_listen) {
        auto socket = listening_socket({address.host, address.port}, SOCK_STREAM);
        if (!socket) return fail(socket.error());
        return std::make_unique<StreamListenLink>(std::move(*socket), hearer);
    }
    auto peers = resolve_host({address.host, address.port}, SOCK_STREAM);
    if (!peers) return fail(peers.error());
    return std::make_unique<StreamConnectLink>(std::move(*peers), hearer);
}

Result<std::unique_ptr<FeedLink>> open_serial_link(const FeedAddress& address, FeedHearer& hearer) {
    auto line = SerialTransport::open({address.host, address.baud, {}});
    if (!line) return fail(line.error());
    return std::make_unique<SerialLink>(std::move(*line), hearer);
}

Result<std::unique_ptr<FeedLink>> open_stream_relay(const FeedAddress& address, FeedHearer& hearer) {
    auto socket = listening_socket({address.host, address.port}, SOCK_STREAM);
    if (!socket) return fail(socket.error());
    auto peers = resolve_host({address.to_host, address.to_port}, SOCK_STREAM);
    if (!peers) return fail(peers.error());
    return std::make_unique<StreamRelay>(std::move(*socket), std::move(*peers), address.hears_target, hearer);
}

}  // namespace skyloop::inline run
