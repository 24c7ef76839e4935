#include "detail/xml_tree.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skyloop::inline motion {
namespace {

// Takes one of the things that may stand before the root element; false where there is none.
bool take_before_root(std::string_view& text) {
    constexpr std::string_view blanks = " \t\r\n";
    struct Prolog {
        std::string_view begin, end;
    };
    static constexpr Prolog prologs[] = {{"<!--", "-->"}, {"<?", "?>"}, {"<!", ">"}};
    if (const std::size_t first = text.find_first_not_of(blanks); first > 0) {
        text.remove_prefix(std::min(first, text.size()));
        return !text.empty();
    }
    for (const Prolog& prolog : prologs) {
        if (!text.starts_with(prolog.begin)) continue;
        const std::size_t end = text.find(prolog.end, prolog.begin.size());
        if (end == std::string_view::npos) return false;
        text.remove_prefix(end + prolog.end.size());
        return true;
    }
    return false;
}

std::string_view without_prefix(std::string_view name) {
    const auto colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

}  // namespace

std::string_view xml_root_name(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    while (take_before_root(text)) {
    }
    if (!text.starts_with('<')) return {};
    text.remove_prefix(1);
    return without_prefix(text.substr(0, std::min<std::size_t>(text.find_first_of(" \t\r\n/>"), 64)));
}

std::string_view xml_name(const pugi::xml_node& node) { return without_prefix(node.name()); }

std::string xml_content(const pugi::xml_node& node) {
    std::string text;
    for (const pugi::xml_node& part : node.children())
        if (part.type() == pugi::node_pcdata || part.type() == pugi::node_cdata) text += part.value();
    return text;
}

pugi::xml_node xml_child(const pugi::xml_node& node, std::string_view name) {
    for (const pugi::xml_node& child : node.children())
        if (xml_name(child) == name) return child;
    return {};
}

pugi::xml_node xml_following(const pugi::xml_node& node, const pugi::xml_node& root) {
    pugi::xml_node at = node;
    do {
        if (const pugi::xml_node below = at.first_child()) {
            at = below;
        } else {
            while (at != root && !at.next_sibling())
                at = at.parent();
            if (at == root) return {};
            at = at.next_sibling();
        }
    } while (at.type() != pugi::node_element);
    return at;
}

Result<XmlTree> XmlTree::of(const TrackFile& file) {
    constexpr std::size_t largest = std::size_t{64} << 20;
    if (file.bytes.size() > largest)
        return fail(ErrorCode::input, fmt::format("{}: {} bytes of XML; expected at most {}: cut it into several files",
                                                  file.name, file.bytes.size(), largest));
    XmlTree tree;
    tree.document_ = std::make_unique<pugi::xml_document>();
    const auto parsed = tree.document_->load_buffer(file.bytes.data(), file.bytes.size());
    if (parsed.encoding == pugi::encoding_utf8) tree.text_ = file.text;
    if (!parsed) {
        const auto at = std::clamp<std::ptrdiff_t>(parsed.offset, 0, static_cast<std::ptrdiff_t>(file.text.size()));
        const auto line = 1 + std::count(file.text.begin(), file.text.begin() + at, '\n');
        return fail(ErrorCode::input, fmt::format("{}:{}: no whole XML: {}", file.name, line, parsed.description()));
    }
    return tree;
}

std::size_t XmlTree::line_of(const pugi::xml_node& node) {
    const std::ptrdiff_t offset = node.offset_debug();
    if (offset < 0 || text_.empty()) return 0;
    const std::size_t at = std::min(static_cast<std::size_t>(offset), text_.size());
    if (at < counted_to_) counted_to_ = 0, line_ = 1;
    const auto from = text_.begin() + static_cast<std::ptrdiff_t>(counted_to_);
    line_ += static_cast<std::size_t>(std::count(from, text_.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    counted_to_ = at;
    return line_;
}

}  // namespace skyloop::inline motion
