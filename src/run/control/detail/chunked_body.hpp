/// What must be there before Beast reads a chunked body.
#pragma once

#include <algorithm>
#include <boost/beast/http/basic_parser.hpp>
#include <cstddef>

namespace skyloop::inline run {

/// Bytes to read before a parser whose header is complete may go on. Beast older than Boost 1.86 asserts that it is not
/// given three or four bytes of a body whose first chunk is its last (boostorg/beast, pull request 2861); no chunked
/// body is shorter than "0\r\n\r\n" (RFC 9112, section 7.1).
/// @param buffered bytes that follow the header and have been read already
template <bool is_request>
std::size_t bytes_before_body(const boost::beast::http::basic_parser<is_request>& parser, std::size_t buffered) {
    constexpr std::size_t shortest_chunked_body = 5;
    return parser.chunked() ? shortest_chunked_body - std::min(shortest_chunked_body, buffered) : 0;
}

}  // namespace skyloop::inline run
