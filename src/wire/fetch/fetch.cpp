#include "wire/fetch/fetch.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <array>
#include <memory>
#include <string_view>

namespace skyloop::inline wire {
namespace {

struct EasyHandle {
    void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};

struct FetchedBytes {
    std::string bytes;
    std::size_t most = 0;
    bool too_many = false;
};

// As CURLOPT_WRITEFUNCTION wants it: another count than that of the bytes ends the transfer.
std::size_t take_bytes(const char* data, std::size_t size, std::size_t count, void* target) {
    auto& fetched = *static_cast<FetchedBytes*>(target);
    fetched.too_many = fetched.bytes.size() + size * count > fetched.most;
    if (fetched.too_many) return 0;
    fetched.bytes.append(data, size * count);
    return size * count;
}

void set_limits(CURL* handle, const FetchLimits& limits) {
    curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT, static_cast<long>(limits.connecting.count()));
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, 1L);
    curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, static_cast<long>(limits.silence.count()));
    curl_easy_setopt(handle, CURLOPT_TIMEOUT, static_cast<long>(limits.whole.count()));
    curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
}

void set_way(CURL* handle, const std::string& address) {
    curl_easy_setopt(handle, CURLOPT_URL, address.c_str());
    curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(handle, CURLOPT_REDIR_PROTOCOLS_STR, address.starts_with("https:") ? "https" : "http,https");
    curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 1L);
    curl_easy_setopt(handle, CURLOPT_MAXREDIRS, 5L);
    curl_easy_setopt(handle, CURLOPT_FAILONERROR, 1L);
    curl_easy_setopt(handle, CURLOPT_USERAGENT, "skyloop");
    // A login by redirection, as that of CDDIS, needs both.
    curl_easy_setopt(handle, CURLOPT_NETRC, static_cast<long>(CURL_NETRC_OPTIONAL));
    curl_easy_setopt(handle, CURLOPT_COOKIEFILE, "");
}

FetchOutcome outcome_of(CURLcode code, CURL* handle) {
    curl_off_t connected_us = 0;
    switch (code) {
        case CURLE_OK:
            return FetchOutcome::found;
        case CURLE_HTTP_RETURNED_ERROR:
            return FetchOutcome::refused;
        case CURLE_COULDNT_RESOLVE_HOST:
        case CURLE_COULDNT_RESOLVE_PROXY:
        case CURLE_COULDNT_CONNECT:
            return FetchOutcome::unreachable;
        case CURLE_OPERATION_TIMEDOUT:
            curl_easy_getinfo(handle, CURLINFO_CONNECT_TIME_T, &connected_us);
            return connected_us > 0 ? FetchOutcome::broken : FetchOutcome::unreachable;
        default:
            return FetchOutcome::broken;
    }
}

}  // namespace

FetchAnswer fetch(const std::string& address, const FetchLimits& limits) {
    const std::unique_ptr<CURL, EasyHandle> handle(curl_easy_init());
    if (!handle) return {FetchOutcome::broken, {}, "libcurl cannot begin"};
    FetchedBytes fetched{{}, limits.most_bytes};
    std::array<char, CURL_ERROR_SIZE> words{};
    set_limits(handle.get(), limits);
    set_way(handle.get(), address);
    curl_easy_setopt(handle.get(), CURLOPT_ERRORBUFFER, words.data());
    curl_easy_setopt(handle.get(), CURLOPT_WRITEFUNCTION, &take_bytes);
    curl_easy_setopt(handle.get(), CURLOPT_WRITEDATA, &fetched);
    const CURLcode code = curl_easy_perform(handle.get());
    const FetchOutcome outcome = outcome_of(code, handle.get());
    if (outcome == FetchOutcome::found) return {outcome, std::move(fetched.bytes), {}};
    if (fetched.too_many) return {outcome, {}, fmt::format("has more than {} bytes", limits.most_bytes)};
    if (outcome == FetchOutcome::refused) {
        long status = 0;
        curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &status);
        return {outcome, {}, fmt::format("{}", status)};
    }
    return {outcome, {}, words[0] != '\0' ? words.data() : curl_easy_strerror(code)};
}

}  // namespace skyloop::inline wire
