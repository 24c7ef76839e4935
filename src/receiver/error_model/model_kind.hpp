/// The sensor models that add errors to the truth, and their names.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace skyloop {

/// Sensor models of the literature (MODELS.md sections 3 and 6).
enum class ErrorModelKind { ideal, constant_sigma, satellite_count, whole_path, refraction, baseline };

/// All of them, in the order in which people list them.
std::span<const ErrorModelKind> error_model_kinds();
/// "ideal", "constant-sigma", "satellite-count", "whole-path", "refraction", "baseline".
std::string_view error_model_name(ErrorModelKind kind);
std::optional<ErrorModelKind> error_model_from_name(std::string_view name);

}  // namespace skyloop
