/// The pictures' colours on a dark page.
#pragma once

#include <string>

namespace skyloop {

/// Rules of a style sheet that give the shapes of pictures inside a page other colours, one to a line. Pictures carry
/// the colours of a light page themselves, so that each stands alone as well.
std::string dark_picture_rules();

}  // namespace skyloop
