#include <optional>
#include <utility>

#include "detail/feed_link.hpp"

namespace skyloop::inline run {
namespace {

constexpr int most_batches = 8;  // in one look, so that a flood does not hold up the rest

// A socket, and whom it speaks to first: nobody, the one that it is connected to, or `asked`, who may answer from
// another port than the one where it hears.
struct DatagramEnd {
    FileDescriptor socket;
    bool connected = false;
    std::optional<FeedPeer> asked{};
};

// Listens to everybody, or speaks first and hears that one alone.
class DatagramLink : public FeedLink {
public:
    DatagramLink(DatagramEnd end, FeedHearer& hearer)
        : socket_(std::move(end.socket)),
          reader_(socket_.value()),
          connected_(end.connected),
          asked_(end.asked),
          hearer_(hearer) {}

    void add_waits(std::vector<pollfd>& waits) const override { waits.push_back({socket_.value(), POLLIN, 0}); }

    bool serve(std::int64_t now_ns) override {
        bool any = false;
        for (int i = 0; i < most_batches; ++i) {
            const auto& datagrams = reader_.take();
            any = any || !datagrams.empty();
            for (const FeedDatagram& datagram : datagrams) {
                if (asked_ && !same_host(*datagram.from, *asked_)) {
                    leave_out(*datagram.from);
                    continue;
                }
                const FeedHearer::Heard heard = hearer_.hear(0, datagram.bytes, datagram.received_ns);
                if (heard.understood && !speaks_first()) peers_.remember(*datagram.from, now_ns);
                for (const Bytes& answer : heard.answers)
                    send_datagram(socket_.value(), answer, connected_ ? nullptr : asked_ ? &*asked_ : datagram.from);
            }
            if (datagrams.size() < DatagramReader::batch) break;
        }
        if (const std::uint64_t dropped = reader_.take_dropped(); dropped > 0) {
            hearer_.tallies().dropped_by_kernel += dropped;
            hearer_.tell(FeedNewsDesk::Kind::drop, std::to_string(dropped) +
                                                       " datagrams dropped by the kernel: they "
                                                       "come faster than they are read");
        }
        return any;
    }

    void speak(std::int64_t now_ns) override {
        peers_.forget_old(now_ns);
        if (!speaks_first() && peers_.empty()) return;
        answer(0, hearer_.say(0));
    }

    void answer(std::uint64_t, const std::vector<Bytes>& answers) override {
        for (const Bytes& bytes : answers) {
            if (speaks_first()) send_datagram(socket_.value(), bytes, asked_ ? &*asked_ : nullptr);
            peers_.send_to_all(socket_.value(), bytes);
        }
    }

    // Of a connected one the other end's is what people know.
    [[nodiscard]] std::uint16_t port() const override { return connected_ ? 0 : own_port(socket_.value()); }

private:
    [[nodiscard]] bool speaks_first() const { return connected_ || asked_; }

    void leave_out(const FeedPeer& stranger) {
        hearer_.tallies().strangers += 1;
        hearer_.tell(FeedNewsDesk::Kind::connection,
                     "datagrams of " + shown_peer(stranger) + " left out: it is another host");
    }

    FileDescriptor socket_;
    DatagramReader reader_;
    bool connected_;
    std::optional<FeedPeer> asked_;
    FeedHearer& hearer_;
    DatagramPeers peers_;
};

// Stands between two programs: every datagram goes on at once, unmodified, and one direction is also heard.
class DatagramRelay : public FeedLink {
public:
    DatagramRelay(FileDescriptor near, FileDescriptor far, bool hears_far, FeedHearer& hearer)
        : near_(std::move(near)),
          far_(std::move(far)),
          near_reader_(near_.value()),
          far_reader_(far_.value()),
          hears_far_(hears_far),
          hearer_(hearer) {}

    void add_waits(std::vector<pollfd>& waits) const override {
        waits.push_back({near_.value(), POLLIN, 0});
        waits.push_back({far_.value(), POLLIN, 0});
    }

    bool serve(std::int64_t now_ns) override {
        const auto& from_near = near_reader_.take();
        for (const FeedDatagram& datagram : from_near) {
            if (!is_the_one(*datagram.from, now_ns)) {
                hearer_.tallies().strangers += 1;
                hearer_.tell(FeedNewsDesk::Kind::connection, "datagrams of " + shown_peer(*datagram.from) +
                                                                 " left out: " + shown_peer(*peer_) + " is connected");
                continue;
            }
            send_datagram(far_.value(), datagram.bytes, nullptr);
        }
        const auto& from_far = far_reader_.take();
        for (const FeedDatagram& datagram : from_far)
            if (peer_) send_datagram(near_.value(), datagram.bytes, &*peer_);
        // First forwarded, then heard: others wait.
        for (const FeedDatagram& datagram : hears_far_ ? from_far : from_near)
            if (hears_far_ || *datagram.from == *peer_) hearer_.hear(0, datagram.bytes, datagram.received_ns);
        if (const std::uint64_t dropped = near_reader_.take_dropped() + far_reader_.take_dropped(); dropped > 0)
            hearer_.tallies().dropped_by_kernel += dropped;
        return !from_near.empty() || !from_far.empty();
    }

    // What a relay would say of itself would not be theirs.
    void speak(std::int64_t) override {}
    void answer(std::uint64_t, const std::vector<Bytes>&) override {}
    [[nodiscard]] std::uint16_t port() const override { return own_port(near_.value()); }
    [[nodiscard]] bool in_haste() const override { return true; }

private:
    bool is_the_one(const FeedPeer& from, std::int64_t now_ns) {
        // After it, another may take its place: a program that was started again speaks from another port. ArduPilot's
        // SITL repeats itself each second while no physics answers.
        constexpr std::int64_t silence_ns = 2'000'000'000;
        if (peer_ && !(*peer_ == from) && now_ns < heard_ns_ + silence_ns) return false;
        peer_ = from;
        heard_ns_ = now_ns;
        return true;
    }

    FileDescriptor near_, far_;
    DatagramReader near_reader_, far_reader_;
    bool hears_far_;
    FeedHearer& hearer_;
    std::optional<FeedPeer> peer_;
    std::int64_t heard_ns_ = 0;
};

Result<DatagramEnd> open_end(const FeedAddress& address) {
    const TcpAddress where{address.host, address.port};
    if (address.wire == FeedWire::udp_request) {
        const auto asked = resolve_host(where, SOCK_DGRAM);
        if (!asked) return fail(asked.error());
        auto socket = bound_datagrams(asked->front(), address.own_port);
        if (!socket) return fail(socket.error());
        return DatagramEnd{std::move(*socket), false, asked->front()};
    }
    const bool connected = address.wire == FeedWire::udp_connect;
    auto socket = connected ? connected_datagrams(where) : listening_socket(where, SOCK_DGRAM);
    if (!socket) return fail(socket.error());
    return DatagramEnd{std::move(*socket), connected};
}

}  // namespace

Result<std::unique_ptr<FeedLink>> open_datagram_link(const FeedAddress& address, FeedHearer& hearer) {
    auto end = open_end(address);
    if (!end) return fail(end.error());
    return std::make_unique<DatagramLink>(std::move(*end), hearer);
}

Result<std::unique_ptr<FeedLink>> open_datagram_relay(const FeedAddress& address, FeedHearer& hearer) {
    auto near = listening_socket({address.host, address.port}, SOCK_DGRAM);
    if (!near) return fail(near.error());
    auto far = connected_datagrams({address.to_host, address.to_port});
    if (!far) return fail(far.error());
    return std::make_unique<DatagramRelay>(std::move(*near), std::move(*far), address.hears_target, hearer);
}

}  // namespace skyloop::inline run
