#include <fmt/format.h>

#include "detail/city_text.hpp"
#include "world/city/city_file.hpp"

namespace skyloop {
namespace {

tl::unexpected<Error> axes_misread(std::string_view text) {
    return fail(ErrorCode::usage,
                fmt::format("axes '{}': expected which of x, y and z point east, north and up, each once, each with an "
                            "optional minus, such as x,y,z or x,-z,y",
                            shown(text)));
}

}  // namespace

Result<FileAxes> FileAxes::parse(std::string_view text) {
    FileAxes axes;
    unsigned seen = 0;
    std::string_view rest = text;
    for (std::size_t i = 0; i < 3; ++i) {
        const bool minus = rest.starts_with('-');
        if (minus) rest.remove_prefix(1);
        if (rest.empty() || rest.front() < 'x' || rest.front() > 'z') return axes_misread(text);
        axes.axis[i] = rest.front() - 'x';
        axes.sign[i] = minus ? -1 : 1;
        seen |= 1U << axes.axis[i];
        rest.remove_prefix(1);
        if (i == 2) break;
        if (!rest.starts_with(',')) return axes_misread(text);
        rest.remove_prefix(1);
    }
    if (!rest.empty() || seen != 7) return axes_misread(text);
    return axes;
}

}  // namespace skyloop
