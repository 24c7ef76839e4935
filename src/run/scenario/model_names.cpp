#include <array>

#include "run/scenario/scenario.hpp"

namespace skyloop {

std::span<const std::string_view> model_names() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> all{"modern"};
        for (const ErrorModelKind kind : error_model_kinds())
            all.push_back(error_model_name(kind));
        return all;
    }();
    return names;
}

std::string_view model_name(const ModelSettings& settings) {
    return settings.sensor_model ? error_model_name(*settings.sensor_model) : model_names().front();
}

bool choose_model(ModelSettings& settings, std::string_view name) {
    const auto sensor_model = error_model_from_name(name);
    if (!sensor_model && name != model_names().front()) return false;
    settings.sensor_model = sensor_model;
    return true;
}

}  // namespace skyloop
