#include "run/control/control_request.hpp"
#include "base/core/letter_case.hpp"

#include <algorithm>

#include "detail/header_text.hpp"
#include "detail/json_text.hpp"

namespace skyloop {
namespace {

bool same_header(std::string_view a, std::string_view b) {
    return a.size() == b.size() && lower_case(a) == lower_case(b);
}

}  // namespace

std::optional<std::string_view> ControlRequest::header(std::string_view name) const {
    std::optional<std::string_view> found;
    for (const auto& [key, value] : headers) {
        if (!same_header(key, name)) continue;
        if (found) return std::nullopt;
        found = value;
    }
    return found.value_or(std::string_view());
}

void ControlRequest::take_absolute_form() {
    constexpr std::string_view scheme = "http://";
    if (lower_case(std::string_view(target).substr(0, scheme.size())) != scheme) return;
    const std::size_t end = std::min(target.find_first_of("/?", scheme.size()), target.size());
    std::string host = target.substr(scheme.size(), end - scheme.size());
    target.erase(0, end);
    if (!target.starts_with('/')) target.insert(0, "/");
    std::erase_if(headers, [](const auto& one) { return same_header(one.first, "Host"); });
    headers.emplace_back("Host", std::move(host));
}

std::string_view ControlRequest::path() const { return std::string_view(target).substr(0, target.find('?')); }

std::optional<std::string_view> ControlRequest::query(std::string_view key) const {
    const std::size_t mark = target.find('?');
    if (mark == std::string::npos) return std::nullopt;
    std::string_view left = std::string_view(target).substr(mark + 1);
    while (!left.empty()) {
        const std::string_view pair = left.substr(0, left.find('&'));
        left.remove_prefix(std::min(pair.size() + 1, left.size()));
        const std::size_t equals = pair.find('=');
        if (pair.substr(0, equals) == key)
            return equals == std::string_view::npos ? std::string_view() : pair.substr(equals + 1);
    }
    return std::nullopt;
}

ControlResponse error_response(int status, std::string_view sentence) {
    ControlResponse response;
    response.status = status;
    response.body = json_text({{"error", sentence}});
    return response;
}

}  // namespace skyloop
