#include "study/plot/dark_picture.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "detail/plot_style.hpp"

namespace skyloop {

std::string dark_picture_rules() {
    namespace style = plot_style;
    constexpr std::array<std::pair<std::string_view, std::string_view>, 8> pairs{{{style::ink, "#e4e9ef"},
                                                                                  {style::faint_ink, "#9aa7b5"},
                                                                                  {style::grid, "#3a4653"},
                                                                                  {style::faint_grid, "#2b3540"},
                                                                                  {style::paper, "#161c23"},
                                                                                  {style::panel, "#1b232c"},
                                                                                  {style::accent, "#ec9a55"},
                                                                                  {style::series, "#6ba3f5"}}};
    std::string rules;
    for (const auto& [light, dark] : pairs)
        rules += fmt::format("svg [fill=\"{0}\"]{{fill:{1}}} svg [stroke=\"{0}\"]{{stroke:{1}}}\n", light, dark);
    return rules;
}

}  // namespace skyloop
