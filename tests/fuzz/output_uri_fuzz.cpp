// Any bytes as the URI of an output: one with an address and numbers within their bounds, or a refusal.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "require.hpp"
#include "run/output/output_settings.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto settings = parse_output_uri(text);
    if (!settings) {
        require(settings.error().code == ErrorCode::usage && !settings.error().message.empty());
        return 0;
    }
    require(text.starts_with(settings->uri));
    require(settings->system >= 1 && settings->component >= 1);
    if (settings->way == OutputWay::file)
        require(!settings->path.empty());
    else
        require(!settings->address.host.empty());
    if (settings->way == OutputWay::udp || settings->way == OutputWay::tcp_client) require(settings->address.port > 0);
    // What is kept of the text means the same without the options.
    const auto again = parse_output_uri(settings->uri);
    require(again && again->format == settings->format && again->way == settings->way &&
            again->address.port == settings->address.port && again->path == settings->path);
    return 0;
}
