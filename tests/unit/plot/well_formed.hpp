/// A small reader of XML that knows enough to say whether a picture is well formed.
#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop::test {

/// What is wrong with the document; empty: it is well formed (elements, attributes, entities; no DTD, no CDATA).
inline std::string xml_fault(std::string_view xml) {
    const auto entity_ok = [](std::string_view text) {
        for (std::size_t at = text.find('&'); at != std::string_view::npos; at = text.find('&', at + 1)) {
            const std::string_view rest = text.substr(at);
            bool known = false;
            for (const std::string_view name : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"})
                known = known || rest.starts_with(name);
            if (!known) return false;
        }
        return true;
    };
    std::vector<std::string> open;
    bool had_root = false;
    if (xml.starts_with("<?xml")) xml.remove_prefix(xml.find("?>") + 2);
    while (!xml.empty()) {
        const std::size_t start = std::min(xml.find('<'), xml.size());
        const std::string_view text = xml.substr(0, start);
        if (!entity_ok(text) || text.find('>') != std::string_view::npos) return "bad text: " + std::string(text);
        if (open.empty() && text.find_first_not_of(" \n") != std::string_view::npos) return "text outside the root";
        xml.remove_prefix(start);
        if (xml.empty()) break;
        // The end of the tag is the first '>' outside quotes.
        std::size_t end = 1;
        for (bool quoted = false; end < xml.size() && (quoted || xml[end] != '>'); ++end)
            if (xml[end] == '"') quoted = !quoted;
        if (end >= xml.size()) return "a tag without an end";
        std::string_view tag = xml.substr(1, end - 1);
        xml.remove_prefix(end + 1);
        if (tag.starts_with('/')) {
            if (open.empty() || open.back() != tag.substr(1)) return "unexpected </" + std::string(tag.substr(1)) + ">";
            open.pop_back();
            continue;
        }
        const bool closed = tag.ends_with('/');
        if (closed) tag.remove_suffix(1);
        const std::size_t name_end = std::min(tag.find(' '), tag.size());
        const std::string name(tag.substr(0, name_end));
        if (open.empty() && had_root) return "a second root <" + name + ">";
        had_root = true;
        std::vector<std::string> seen;
        for (std::string_view rest = tag.substr(name_end); rest.find_first_not_of(' ') != std::string_view::npos;) {
            rest.remove_prefix(rest.find_first_not_of(' '));
            const std::size_t equals = rest.find("=\"");
            if (equals == std::string_view::npos) return "bad attribute in <" + std::string(tag) + ">";
            const std::string attribute(rest.substr(0, equals));
            for (const std::string& other : seen)
                if (other == attribute) return "attribute twice: " + attribute;
            seen.push_back(attribute);
            rest.remove_prefix(equals + 2);
            const std::size_t quote = rest.find('"');
            const std::string_view value = rest.substr(0, quote);
            if (!entity_ok(value) || value.find('<') != std::string_view::npos) return "bad value of " + attribute;
            rest.remove_prefix(quote + 1);
        }
        if (!closed) open.push_back(name);
    }
    if (!open.empty()) return "<" + open.back() + "> is not closed";
    return had_root ? "" : "no root";
}

/// How often `part` occurs in `text`.
inline std::size_t occurrences(std::string_view text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + part.size()))
        ++count;
    return count;
}

}  // namespace skyloop::test
