#include "wire/ntrip/ntrip_caster.hpp"

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <thread>

#include "base/core/threads.hpp"
#include "detail/caster_session.hpp"

namespace skyloop::inline wire {

using boost::asio::ip::tcp;

class NtripCaster::Impl {
public:
    explicit Impl(NtripCasterSettings settings) : core_(std::move(settings)) {
        core_.make_room = [this] {
            if (!accepting_) accept();
        };
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        io_.stop();
        if (thread_.joinable()) thread_.join();
        core_.make_room = {};
    }

    Result<void> listen() {
        const TcpAddress& asked = core_.settings.address;
        const auto refused = [&](const boost::system::error_code& error) {
            return fail(ErrorCode::outside,
                        fmt::format("caster {}: cannot be listened at: {}", shown_address(asked), error.message()));
        };
        boost::system::error_code error;
        const auto found =
            tcp::resolver(io_).resolve(asked.host, std::to_string(asked.port), tcp::resolver::passive, error);
        if (error || found.empty()) return refused(error);
        const tcp::endpoint where = found.begin()->endpoint();
        acceptor_.open(where.protocol(), error);
        if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
        if (!error) acceptor_.bind(where, error);
        if (!error) acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
        if (error) return refused(error);
        address_ = {asked.host, acceptor_.local_endpoint().port()};
        loopback_ = where.address().is_loopback();
        accept();
        with_signals_held_back([this] { thread_ = std::thread([this] { io_.run(); }); });
        return {};
    }

    void wake() {
        if (woken_.exchange(true)) return;
        boost::asio::post(io_, [this] {
            woken_ = false;
            pump_ntrip(core_);
        });
    }

    [[nodiscard]] const TcpAddress& address() const { return address_; }
    [[nodiscard]] bool loopback() const { return loopback_; }
    [[nodiscard]] const CasterCore& core() const { return core_; }

private:
    // Who is not let in waits in the queue of the system.
    void accept() {
        accepting_ = core_.asking < most_asking && !io_.stopped();
        if (!accepting_) return;
        acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
            if (!error) {
                serve_ntrip(core_, std::move(socket));
                return accept();
            }
            // Out of descriptors, most likely: the next look may find one.
            constexpr std::chrono::milliseconds pause{100};
            retry_.expires_after(pause);
            retry_.async_wait([this](boost::system::error_code cancelled) {
                if (!cancelled) accept();
            });
        });
    }

    CasterCore core_;  // outlives the connections, which the next member owns
    boost::asio::io_context io_{1};
    tcp::acceptor acceptor_{io_};
    boost::asio::steady_timer retry_{io_};
    TcpAddress address_;
    std::atomic<bool> woken_{false};
    bool loopback_ = true, accepting_ = false;
    std::thread thread_;
};

NtripCaster::NtripCaster(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
NtripCaster::~NtripCaster() = default;

Result<std::unique_ptr<NtripCaster>> NtripCaster::start(NtripCasterSettings settings) {
    auto impl = std::make_unique<Impl>(std::move(settings));
    if (const auto listening = impl->listen(); !listening) return fail(listening.error());
    return std::unique_ptr<NtripCaster>(new NtripCaster(std::move(impl)));
}

void NtripCaster::wake() { impl_->wake(); }
const TcpAddress& NtripCaster::address() const { return impl_->address(); }
bool NtripCaster::loopback() const { return impl_->loopback(); }
NtripCasterCounts NtripCaster::counts() const {
    const CasterCore& core = impl_->core();
    return {core.clients, core.served, core.refused, core.slow, core.bytes};
}

}  // namespace skyloop::inline wire
