#include "wire/ntrip/ntrip_answer.hpp"

#include <algorithm>
#include <boost/beast/http/parser.hpp>
#include <limits>
#include <utility>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "wire/ntrip/ntrip_messages.hpp"

namespace skyloop::inline wire {
namespace {

namespace http = boost::beast::http;
using Kind = NtripVerdict::Kind;

constexpr std::string_view icy = "ICY 200 OK\r\n", table_line = "SOURCETABLE 200 OK\r\n", error_word = "ERROR - ";

bool may_become(std::string_view begin, std::string_view whole) {
    return whole.starts_with(begin.substr(0, whole.size()));
}

Kind refusal_of(unsigned status) {
    return status == 401 ? Kind::bad_password : status == 404 ? Kind::no_such_mount : Kind::refused;
}

std::string first_line(std::string_view text) {
    constexpr std::size_t longest = 80;
    const std::string_view line = text.substr(0, std::min(text.find_first_of("\r\n"), longest));
    return on_a_terminal(line);
}

// A header of an answer of version 1: a name, a colon, no data of a receiver.
bool is_header_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
}

}  // namespace

// Takes what the parser finds in a body of any length. Whoever feeds the parser empties it.
struct PiecesBody {
    using value_type = Bytes;
    class reader {
    public:
        template <bool is_request, class Fields>
        reader(http::header<is_request, Fields>&, value_type& pieces) : pieces_(pieces) {}
        void init(const boost::optional<std::uint64_t>&, boost::system::error_code& error) { error = {}; }
        template <class Buffers>
        std::size_t put(const Buffers& buffers, boost::system::error_code& error) {
            error = {};
            std::size_t count = 0;
            for (auto at = boost::asio::buffer_sequence_begin(buffers); at != boost::asio::buffer_sequence_end(buffers);
                 ++at) {
                const boost::asio::const_buffer piece = *at;
                const auto* begin = static_cast<const std::uint8_t*>(piece.data());
                pieces_.insert(pieces_.end(), begin, begin + piece.size());
                count += piece.size();
            }
            return count;
        }
        void finish(boost::system::error_code& error) { error = {}; }

    private:
        value_type& pieces_;
    };
};

class NtripAnswer::Impl {
public:
    Impl() {
        parser_.header_limit(longest_ntrip_head);
        parser_.body_limit(std::numeric_limits<std::uint64_t>::max());  // none: Boost 1.74 refuses every length then
    }

    Bytes feed(ByteSpan bytes) {
        if (over) return {};
        pending_.append(bytes.begin(), bytes.end());
        if (state_ == State::begin) read_begin();
        if (state_ == State::icy_head) read_icy_head();
        if (state_ == State::http) return read_http();
        if (state_ != State::raw) return {};
        Bytes rest(pending_.begin(), pending_.end());
        pending_.clear();
        return rest;
    }

    void finish() {
        over = true;
        constexpr std::size_t status_at = 9;  // behind "HTTP/1.1 "
        if (verdict || state_ != State::http || line_.size() <= status_at) return;
        const unsigned status = number_in<unsigned>(line_.substr(status_at, 3)).value_or(0);
        decide(status >= 300 ? refusal_of(status) : Kind::foreign, 1);
    }

    std::optional<NtripVerdict> verdict;
    bool over = false;

private:
    enum class State { begin, icy_head, http, raw };

    void decide(Kind kind, int version) {
        if (!verdict) verdict = NtripVerdict{kind, version, first_line(line_.empty() ? pending_ : line_)};
    }

    void break_off(Kind kind) {
        decide(kind, 2);
        over = true;
        pending_.clear();
    }

    void read_begin() {
        if (pending_.starts_with(icy)) {
            line_ = first_line(pending_);
            pending_.erase(0, icy.size());
            decide(Kind::stream, 1);
            state_ = State::icy_head;
        } else if (pending_.starts_with(table_line)) {
            line_ = first_line(pending_);
            // From here on it is like HTTP.
            pending_.replace(0, table_line.size(), "HTTP/1.0 200 OK\r\n");
            old_table_ = true;
            state_ = State::http;
        } else if (pending_.starts_with("HTTP/1.")) {
            state_ = State::http;
        } else if (pending_.starts_with(error_word) && pending_.find('\n') != std::string::npos) {
            line_ = first_line(pending_);
            break_off(lower_case(line_).find("password") != std::string::npos ? Kind::bad_password : Kind::refused);
        } else if (!may_become(pending_, icy) && !may_become(pending_, table_line) &&
                   !may_become(pending_, "HTTP/1.") && !pending_.starts_with(error_word) &&
                   !may_become(pending_, error_word)) {
            break_off(Kind::foreign);
        } else if (pending_.size() > longest_ntrip_head) {
            break_off(Kind::foreign);
        }
    }

    // Casters end the answer of version 1 with its line, with an empty line, or with headers and an empty line.
    void read_icy_head() {
        while (!pending_.empty() && state_ == State::icy_head) {
            if (pending_ == "\r") return;
            const std::size_t name = static_cast<std::size_t>(
                std::find_if_not(pending_.begin(), pending_.end(), is_header_letter) - pending_.begin());
            const std::size_t end = pending_.find("\r\n");
            const bool may_be_name = name > 0 && name <= longest_header_name;
            if (may_be_name && name == pending_.size()) return;
            const bool is_header = may_be_name && pending_[name] == ':';
            if (is_header && end == std::string::npos && pending_.size() <= longest_ntrip_head) return;
            if (end == 0 || !is_header || end == std::string::npos) state_ = State::raw;
            if (end == 0 || state_ == State::icy_head) pending_.erase(0, end + 2);
        }
    }

    Bytes read_http() {
        if (line_.empty() && pending_.find('\n') != std::string::npos) line_ = first_line(pending_);
        boost::system::error_code error;
        if (!parser_.is_header_done()) {
            put(error);
            if (error && error != http::error::need_more) return break_off(Kind::foreign), Bytes();
            if (!parser_.is_header_done()) return {};
            judge();
            parser_.eager(true);
        }
        // Beast older than Boost 1.86 asserts that it is not given three or four bytes of a body whose first chunk is
        // its last (boostorg/beast, pull request 2861); no chunked body is shorter than "0\r\n\r\n".
        constexpr std::size_t shortest_chunked_body = 5;
        if (parser_.chunked() && !body_begun_ && pending_.size() < shortest_chunked_body) return {};
        body_begun_ = true;
        while (!pending_.empty() && !parser_.is_done()) {
            if (put(error) == 0 || error) break;
        }
        over = parser_.is_done() || (error && error != http::error::need_more) || pending_.size() > longest_ntrip_head;
        return std::exchange(parser_.get().body(), {});
    }

    std::size_t put(boost::system::error_code& error) {
        error = {};
        const std::size_t taken = parser_.put(boost::asio::buffer(pending_), error);
        pending_.erase(0, taken);
        return taken;
    }

    void judge() {
        const auto& message = parser_.get();
        const unsigned status = message.result_int();
        const auto type = message[http::field::content_type];
        const std::string kind = lower_case(std::string_view(type.data(), type.size()));
        const int version = old_table_ || message.find("Ntrip-Version") == message.end() ? 1 : 2;
        if (old_table_ || (status == 200 && kind.starts_with("gnss/sourcetable")))
            decide(Kind::table, version);
        else if (status == 200 && (kind.starts_with("gnss/") || kind == "application/octet-stream"))
            decide(Kind::stream, 2);
        else
            // A page for people: a web server answers there.
            decide(status == 200 ? Kind::foreign : refusal_of(status), version);
    }

    static constexpr std::size_t longest_header_name = 40;

    State state_ = State::begin;
    std::string pending_, line_;
    http::response_parser<PiecesBody> parser_;
    bool old_table_ = false, body_begun_ = false;
};

NtripAnswer::NtripAnswer() : impl_(std::make_unique<Impl>()) {}
NtripAnswer::~NtripAnswer() = default;
NtripAnswer::NtripAnswer(NtripAnswer&&) noexcept = default;
NtripAnswer& NtripAnswer::operator=(NtripAnswer&&) noexcept = default;

Bytes NtripAnswer::feed(ByteSpan bytes) { return impl_->feed(bytes); }
void NtripAnswer::finish() { impl_->finish(); }
const std::optional<NtripVerdict>& NtripAnswer::verdict() const { return impl_->verdict; }
bool NtripAnswer::over() const { return impl_->over; }

}  // namespace skyloop::inline wire
