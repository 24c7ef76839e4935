/// A picture as SVG 1.1 text: shapes in drawing order, always well formed, the same bytes for the same calls.
/// The pictures' colours on a dark page.
#pragma once

#include <string>
#include <string_view>

namespace skyloop::inline study {

/// A point of the picture, pixels right and down from the upper left corner.
struct SvgPoint {
    double x = 0, y = 0;
};

/// How a shape is painted. Colours as SVG writes them ("#1f5fbf", "none").
struct SvgStyle {
    std::string_view fill = "none";
    std::string_view stroke = "none";
    double width = 1;  ///< of the stroke, pixels
    double opacity = 1;
    std::string_view dash = "";  ///< lengths of dashes and gaps, "4 3"; empty: solid
};

/// One line of text.
struct SvgText {
    SvgPoint at;  ///< the anchor, vertically the middle of small capitals
    std::string text;
    double size = 12;  ///< pixels
    std::string_view fill = "#1f2933";
    std::string_view anchor = "start";  ///< "start", "middle" or "end"
    bool bold = false;
    std::string_view halo = "";  ///< colour of an outline that keeps the text readable over lines; empty: none
    double rotation_deg = 0;     ///< clockwise about the anchor
};

/// A path of straight lines.
class SvgPath {
public:
    SvgPath& move_to(SvgPoint p);
    SvgPath& line_to(SvgPoint p);
    SvgPath& close();
    [[nodiscard]] const std::string& data() const { return data_; }
    [[nodiscard]] bool empty() const { return data_.empty(); }

private:
    std::string data_;
};

/// The picture. Its state is the text written so far and the number of open groups.
class SvgDocument {
public:
    /// @param title for screen readers and as the picture's tooltip
    SvgDocument(double width, double height, std::string_view title);

    /// Starts a group of shapes; `tooltip` is shown when the pointer rests on it.
    void begin_group(std::string_view name, std::string_view tooltip = "");
    void end_group();
    void rectangle(SvgPoint corner, SvgPoint size, double corner_radius, const SvgStyle& style);
    void circle(SvgPoint centre, double radius, const SvgStyle& style);
    /// An ellipse whose first half-axis points `rotation_deg` clockwise from the right.
    void ellipse(SvgPoint centre, SvgPoint half_axes, double rotation_deg, const SvgStyle& style);
    void line(SvgPoint from, SvgPoint to, const SvgStyle& style);
    void path(const SvgPath& path, const SvgStyle& style);
    /// Straight strokes with blunt ends: the cells of a raster.
    void runs(const SvgPath& path, std::string_view colour, double width);
    void text(const SvgText& text);

    /// The whole document; open groups are closed.
    [[nodiscard]] std::string str() const;
    /// The picture alone, without the declaration of XML, to stand inside a page.
    [[nodiscard]] std::string element() const;

private:
    std::string body_;
    int open_groups_ = 0;
};

/// A number with two decimals, no negative zero; a number that is not finite becomes 0.
std::string svg_number(double value);
/// Text for XML content and attributes: markup escaped, control characters dropped, what is not UTF-8 replaced by
/// U+FFFD.
std::string svg_escape(std::string_view text);

/// Rules of a style sheet that give the shapes of pictures inside a page other colours, one to a line. Pictures carry
/// the colours of a light page themselves, so that each stands alone as well.
std::string dark_picture_rules();

}  // namespace skyloop::inline study
