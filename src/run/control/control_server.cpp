#include "run/control/control_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <random>
#include <thread>

#include "base/core/number_text.hpp"
#include "detail/server_core.hpp"
#include "run/control/status_json.hpp"
#include "run/emulator/director.hpp"
#include "run/emulator/real_time.hpp"

namespace skyloop::inline run {
namespace {

using boost::asio::ip::tcp;
using boost::beast::error_code;

constexpr std::size_t longest_token = 200, most_started_names = 1000;
constexpr std::chrono::milliseconds accept_pause{100};

// Letters of RFC 6750's b64token that may also stand in a subprotocol's name and an address.
bool is_token_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' ||
           c == '.';
}

// 128 bits from the system: a secret, which no seed may repeat.
std::string random_token() {
    std::random_device source;
    std::string token;
    for (int i = 0; i < 4; ++i)
        token += fmt::format("{:08x}", source() & 0xFFFFFFFFU);
    return token;
}

Result<tcp::endpoint> control_endpoint(boost::asio::io_context& io, const ControlOptions& options) {
    error_code error;
    tcp::resolver resolver(io);
    const auto found = resolver.resolve(options.host, std::to_string(options.port), tcp::resolver::passive, error);
    if (error || found.empty())
        return fail(ErrorCode::outside,
                    fmt::format("--control: host '{}' is not known: {}", options.host, error.message()));
    return found.begin()->endpoint();
}

std::string shown_host(const std::string& host) {
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

}  // namespace

bool ServerCore::push(Command command) {
    std::set<std::string> names;
    if (begins_new_fault(command)) names = {command.parameters.text("name"), given_fault_name(command, sources(false))};
    if (!parts.commands.push(std::move(command))) return false;
    if (started.size() >= most_started_names) started.clear();
    started.merge(names);
    return true;
}

ControlSources ServerCore::sources(bool with_status) {
    ControlSources sources;
    sources.snapshot = parts.board.latest();
    sources.push = [this](Command command) { return push(std::move(command)); };
    sources.receivers = &parts.receivers;
    sources.measuring = parts.measuring;
    sources.started = &started;
    sources.scene = &parts.scene;
    sources.version = parts.version;
    if (!with_status || !sources.snapshot) return sources;
    if (status_sequence != sources.snapshot->sequence) {
        status_text = recent_status_json(*sources.snapshot);
        status_sequence = sources.snapshot->sequence;
    }
    sources.status = &status_text;
    return sources;
}

Result<ControlOptions> parse_control_address(std::string_view text) {
    ControlOptions options;
    const std::size_t colon = text.rfind(':');
    std::string_view port = text;
    if (colon != std::string_view::npos) {
        std::string_view host = text.substr(0, colon);
        port = text.substr(colon + 1);
        if (host.starts_with('[') && host.ends_with(']'))
            host = host.substr(1, host.size() - 2);
        else if (host.find(':') != std::string_view::npos)
            host = {};
        options.host = host;
    }
    const auto number = number_in<std::uint16_t>(port);
    if (options.host.empty() || !number)
        return fail(ErrorCode::usage,
                    fmt::format("'{}' is no control address; expected [HOST:]PORT, PORT from 0 to 65535", text));
    options.port = *number;
    return options;
}

class ControlServer::Impl {
public:
    explicit Impl(const ControlParts& parts) : core_(parts) {}
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        io_.stop();
        if (thread_.joinable()) thread_.join();
    }

    Result<void> listen(const ControlOptions& options) {
        const auto endpoint = control_endpoint(io_, options);
        if (!endpoint) return fail(endpoint.error());
        core_.rules = {options.token, shown_host(options.host), endpoint->address().is_loopback()};
        if (core_.rules.token.empty() && !core_.rules.loopback) core_.rules.token = random_token();
        error_code error;
        acceptor_.open(endpoint->protocol(), error);
        if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
        if (!error) acceptor_.bind(*endpoint, error);
        if (!error) acceptor_.listen(boost::asio::socket_base::max_listen_connections, error);
        if (error)
            return fail(ErrorCode::outside, fmt::format("--control: cannot listen at {}:{}: {}", core_.rules.host,
                                                        options.port, error.message()));
        core_.port = acceptor_.local_endpoint().port();
        accept();
        thread_ = background_thread([this] { io_.run(); });
        return {};
    }

    [[nodiscard]] const ServerCore& core() const { return core_; }

private:
    void accept() {
        acceptor_.async_accept([this](error_code error, tcp::socket socket) {
            if (!error) {
                take(std::move(socket));
                return accept();
            }
            // Out of descriptors, most likely: the next look may find one.
            retry_.expires_after(accept_pause);
            retry_.async_wait([this](error_code cancelled) {
                if (!cancelled) accept();
            });
        });
    }

    void take(tcp::socket socket) {
        error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        if (core_.clients < most_clients) return serve_http(core_, std::move(socket), ClientSlot(core_.clients));
        if (core_.refused_clients < most_refused_clients)
            refuse_client(core_, std::move(socket), ClientSlot(core_.refused_clients));
    }

    ServerCore core_;  // outlives the connections, which the next member owns
    boost::asio::io_context io_{1};
    tcp::acceptor acceptor_{io_};
    boost::asio::steady_timer retry_{io_};
    std::thread thread_;
};

ControlServer::ControlServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ControlServer::~ControlServer() = default;

Result<std::unique_ptr<ControlServer>> ControlServer::start(const ControlOptions& options, const ControlParts& parts) {
    if (options.token.size() > longest_token ||
        !std::all_of(options.token.begin(), options.token.end(), is_token_letter))
        return fail(ErrorCode::usage,
                    "the control token is not usable; expected at most 200 letters, digits, '-', '_' and '.'");
    auto impl = std::make_unique<Impl>(parts);
    const auto listening = impl->listen(options);
    if (!listening) return fail(listening.error());
    return std::unique_ptr<ControlServer>(new ControlServer(std::move(impl)));
}

std::uint16_t ControlServer::port() const { return impl_->core().port; }
const std::string& ControlServer::token() const { return impl_->core().rules.token; }
std::string ControlServer::url() const {
    const std::string address = fmt::format("http://{}:{}/", impl_->core().rules.host, port());
    return token().empty() ? address : address + "#token=" + token();
}

}  // namespace skyloop::inline run
