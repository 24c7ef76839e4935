// Any bytes as a request: method, target, headers up to an empty line, body. Whatever is refused is refused in JSON of
// one line, and nothing is taken from a page of another site or without the token.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "require.hpp"
#include "run/control/control_request.hpp"

namespace {

using namespace skyloop;

std::string_view taken_line(std::string_view& text) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
}

ControlRequest request_of(std::string_view text) {
    ControlRequest request;
    request.method = taken_line(text);
    request.target = taken_line(text);
    while (!text.empty()) {
        const std::string_view line = taken_line(text);
        if (line.empty()) break;
        const std::size_t colon = line.find(':');
        request.headers.emplace_back(line.substr(0, colon),
                                     colon == std::string_view::npos ? "" : line.substr(colon + 1));
    }
    request.body = text;
    return request;
}

void check_answer(const ControlRequest& request, const AccessRules& rules) {
    auto snapshot = std::make_shared<StatusSnapshot>();
    snapshot->timeline.resize(1);
    snapshot->timeline[0].name = "plug";
    int pushed = 0;
    ControlSources sources;
    sources.snapshot = snapshot;
    sources.push = [&pushed](const Command&) { return ++pushed == 1; };
    const bool refused = refusal(request, rules).has_value();
    const ControlResponse response = answer(request, rules, sources);
    require(response.status >= 200 && response.status < 600 && pushed <= 1);
    require(!refused || pushed == 0);
    require((response.status == 202) == (pushed == 1));
    if (response.status >= 400) {
        const auto json = nlohmann::json::parse(response.body, nullptr, false);
        require(json.is_object() && json.size() == 1 && json.contains("error") && json["error"].is_string());
        require(response.body.find('\n') == std::string::npos);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const ControlRequest request = request_of({reinterpret_cast<const char*>(data), size});
    check_answer(request, {"", "127.0.0.1", true});
    check_answer(request, {"secret", "0.0.0.0", false});
    return 0;
}
