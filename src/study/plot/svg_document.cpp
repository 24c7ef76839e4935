#include "study/plot/svg_document.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/core/words.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

// Fonts that every system has one of; nothing is loaded from elsewhere.
constexpr std::string_view font_family =
    "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', Arial, sans-serif";

std::string style_attributes(const SvgStyle& style) {
    std::string text = fmt::format(" fill=\"{}\"", svg_escape(style.fill));
    if (style.stroke != "none")
        text += fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", svg_escape(style.stroke), svg_number(style.width));
    if (!style.dash.empty()) text += fmt::format(" stroke-dasharray=\"{}\"", svg_escape(style.dash));
    if (style.opacity < 1) text += fmt::format(" opacity=\"{}\"", svg_number(style.opacity));
    return text;
}

std::string point_text(SvgPoint p) { return svg_number(p.x) + " " + svg_number(p.y); }

}  // namespace

std::string svg_number(double value) {
    constexpr double shown_as_zero = 0.005;
    if (!std::isfinite(value) || std::abs(value) < shown_as_zero) value = 0;
    std::string text = fmt::format("{:.2f}", value);
    // A third of a picture is digits: what says nothing is left out.
    while (text.ends_with('0'))
        text.pop_back();
    if (text.ends_with('.')) text.pop_back();
    return text;
}

std::string svg_escape(std::string_view text) {
    std::string escaped;
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const char c = text[0];
        if (length == 0)
            escaped += "\xEF\xBF\xBD";
        else if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else if (c == '>')
            escaped += "&gt;";
        else if (c == '"')
            escaped += "&quot;";
        else if (c == '\'')
            escaped += "&#39;";
        else if (length > 1 || static_cast<unsigned char>(c) >= 0x20)
            escaped += text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return escaped;
}

SvgPath& SvgPath::move_to(SvgPoint p) {
    data_ += "M" + point_text(p);
    return *this;
}

SvgPath& SvgPath::line_to(SvgPoint p) {
    data_ += "L" + point_text(p);
    return *this;
}

SvgPath& SvgPath::close() {
    data_ += "Z";
    return *this;
}

SvgDocument::SvgDocument(double width, double height, std::string_view title) {
    const std::string w = svg_number(width);
    const std::string h = svg_number(height);
    body_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" "
        "height=\"{1}\" viewBox=\"0 0 {0} {1}\" role=\"img\" font-family=\"{2}\">\n<title>{3}</title>\n",
        w, h, font_family, svg_escape(title));
}

void SvgDocument::begin_group(std::string_view name, std::string_view tooltip) {
    body_ += fmt::format("<g class=\"{}\">\n", svg_escape(name));
    if (!tooltip.empty()) body_ += fmt::format("<title>{}</title>\n", svg_escape(tooltip));
    ++open_groups_;
}

void SvgDocument::end_group() {
    if (open_groups_ == 0) return;
    body_ += "</g>\n";
    --open_groups_;
}

void SvgDocument::rectangle(SvgPoint corner, SvgPoint size, double corner_radius, const SvgStyle& style) {
    body_ += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"{}\"{}/>\n", svg_number(corner.x),
                         svg_number(corner.y), svg_number(size.x), svg_number(size.y), svg_number(corner_radius),
                         style_attributes(style));
}

void SvgDocument::circle(SvgPoint centre, double radius, const SvgStyle& style) {
    body_ += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", svg_number(centre.x), svg_number(centre.y),
                         svg_number(radius), style_attributes(style));
}

void SvgDocument::ellipse(SvgPoint centre, SvgPoint half_axes, double rotation_deg, const SvgStyle& style) {
    body_ +=
        fmt::format("<ellipse cx=\"{0}\" cy=\"{1}\" rx=\"{2}\" ry=\"{3}\" transform=\"rotate({4} {0} {1})\"{5}/>\n",
                    svg_number(centre.x), svg_number(centre.y), svg_number(half_axes.x), svg_number(half_axes.y),
                    svg_number(rotation_deg), style_attributes(style));
}

void SvgDocument::line(SvgPoint from, SvgPoint to, const SvgStyle& style) {
    body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"{}/>\n", svg_number(from.x), svg_number(from.y),
                         svg_number(to.x), svg_number(to.y), style_attributes(style));
}

void SvgDocument::path(const SvgPath& path, const SvgStyle& style) {
    if (path.empty()) return;
    body_ += fmt::format("<path d=\"{}\"{} stroke-linejoin=\"round\" stroke-linecap=\"round\"/>\n", path.data(),
                         style_attributes(style));
}

void SvgDocument::runs(const SvgPath& path, std::string_view colour, double width) {
    body_ += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>\n", path.data(),
                         svg_escape(colour), svg_number(width));
}

void SvgDocument::text(const SvgText& text) {
    constexpr double half_height_of_capitals = 0.36;  // of the font size, for any common sans-serif
    body_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{}\"",
                         svg_number(text.at.x), svg_number(text.at.y + half_height_of_capitals * text.size),
                         svg_number(text.size), svg_escape(text.anchor), svg_escape(text.fill));
    if (text.bold) body_ += " font-weight=\"600\"";
    if (!text.halo.empty())
        body_ += fmt::format(" stroke=\"{}\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"",
                             svg_escape(text.halo));
    if (text.rotation_deg != 0)
        body_ += fmt::format(" transform=\"rotate({} {} {})\"", svg_number(text.rotation_deg), svg_number(text.at.x),
                             svg_number(text.at.y));
    body_ += ">" + svg_escape(text.text) + "</text>\n";
}

std::string SvgDocument::str() const { return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + element(); }

std::string SvgDocument::element() const {
    std::string document = body_;
    for (int i = 0; i < open_groups_; ++i)
        document += "</g>\n";
    return document + "</svg>\n";
}

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

}  // namespace skyloop::inline study
