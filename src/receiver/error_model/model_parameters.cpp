#include "receiver/error_model/model_parameters.hpp"

#include <array>

namespace skyloop::inline receiver {
namespace {

constexpr std::array all_kinds{ErrorModelKind::ideal,           ErrorModelKind::constant_sigma,
                               ErrorModelKind::satellite_count, ErrorModelKind::whole_path,
                               ErrorModelKind::refraction,      ErrorModelKind::baseline};
// In the same order, which is that of the enumeration too.
constexpr std::array<std::string_view, all_kinds.size()> kind_names{"ideal",      "constant-sigma", "satellite-count",
                                                                    "whole-path", "refraction",     "baseline"};

}  // namespace

std::span<const ErrorModelKind> error_model_kinds() { return all_kinds; }

std::string_view error_model_name(ErrorModelKind kind) { return kind_names.at(static_cast<std::size_t>(kind)); }

std::optional<ErrorModelKind> error_model_from_name(std::string_view name) {
    for (const ErrorModelKind kind : all_kinds)
        if (error_model_name(kind) == name) return kind;
    return std::nullopt;
}

}  // namespace skyloop::inline receiver
