// Values of JSON objects that come from others.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace skyloop {

// A finite number; nothing when it is not there or anything else.
inline std::optional<double> source_json_number(const nlohmann::json& object, std::string_view key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return std::nullopt;
    const double value = found->get<double>();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

// Three finite numbers.
inline std::optional<Eigen::Vector3d> source_json_triple(const nlohmann::json& object, std::string_view key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array() || found->size() != 3) return std::nullopt;
    Eigen::Vector3d triple;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(*found)[i].is_number()) return std::nullopt;
        triple(static_cast<Eigen::Index>(i)) = (*found)[i].get<double>();
    }
    return triple.allFinite() ? std::optional(triple) : std::nullopt;
}

// Empty when it is not there or no text.
inline std::string source_json_text(const nlohmann::json& object, std::string_view key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace skyloop
