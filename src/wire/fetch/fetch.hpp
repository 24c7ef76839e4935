/// Files from the web, by http and https: the only folder with libcurl.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace skyloop::inline wire {

struct FetchLimits {
    std::size_t most_bytes = std::size_t{64} << 20;
    std::chrono::seconds connecting{15};
    std::chrono::seconds silence{30};  ///< in which nothing comes
    std::chrono::seconds whole{600};
};

/// What became of a request.
enum class FetchOutcome {
    found,
    refused,      ///< the server has no such file, or not for everybody
    unreachable,  ///< nobody answers
    broken,       ///< what came is not all of it, too much, or not to be trusted
};

struct FetchAnswer {
    FetchOutcome outcome = FetchOutcome::broken;
    std::string bytes{};    ///< when found
    std::string problem{};  ///< else, in words: "404"
};

/// Gets a file. Up to five redirections are followed, from https to https alone. A server by https must show a
/// certificate of its host that the system trusts; who wants a login gets that of ~/.netrc. Proxies are those of the
/// environment (https_proxy, no_proxy).
/// @param address http or https
FetchAnswer fetch(const std::string& address, const FetchLimits& limits = {});

}  // namespace skyloop::inline wire
