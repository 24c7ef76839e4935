#include "receiver/error_model/model_parameters.hpp"

#include <array>

namespace skyloop::inline receiver {
namespace {

constexpr std::array all_kinds{ErrorModelKind::ideal,           ErrorModelKind::constant_sigma,
                               ErrorModelKind::satellite_count, ErrorModelKind::whole_path,
                               ErrorModelKind::refraction,      ErrorModelKind::baseline};

}  // namespace

std::span<const ErrorModelKind> error_model_kinds() { return all_kinds; }

std::string_view error_model_name(ErrorModelKind kind) {
    switch (kind) {
        case ErrorModelKind::ideal:
            return "ideal";
        case ErrorModelKind::constant_sigma:
            return "constant-sigma";
        case ErrorModelKind::satellite_count:
            return "satellite-count";
        case ErrorModelKind::whole_path:
            return "whole-path";
        case ErrorModelKind::refraction:
            return "refraction";
        case ErrorModelKind::baseline:
            return "baseline";
    }
    return "baseline";
}

std::optional<ErrorModelKind> error_model_from_name(std::string_view name) {
    for (const ErrorModelKind kind : all_kinds)
        if (error_model_name(kind) == name) return kind;
    return std::nullopt;
}

}  // namespace skyloop::inline receiver
